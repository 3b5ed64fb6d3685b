"""What comparisons claim of one window or of yaws found from positions, and few windows to fit."""

from dataclasses import dataclass

import numpy as np

from odometry.comparison.candidates import IdentifiedModel
from odometry.comparison.compare import compare
from odometry.comparison.config import ComparisonConfig
from odometry.comparison.files import write_comparison
from odometry.comparison.split import splits, training_windows
from odometry.models.catalogue import MODELS
from odometry.windows.config import WindowConfig
from tests.odometry.positions_drives import drive, emptied, slower

SEEN = []


@dataclass(frozen=True)
class Spied(IdentifiedModel):
    def on(self, split, config, near=None):
        SEEN.append(config.training.horizon_m)
        return super().on(split, config, near)


def test_one_window_orders_no_models(tmp_path):
    short = drive(3, duration_s=6.0, noise_m=0.01, name="short")
    compared = compare([short], train=[drive(4, name="long")])
    assert compared.differences == ()
    (place,) = compared.places
    assert any(
        "in one window: that shows no order" in line for line in compared.sentences_at(place)
    )
    write_comparison(compared, tmp_path / "compared")


def test_models_are_identified_on_more_windows_where_there_are_few():
    slow = slower(drive(3, duration_s=40.0), 5.0)
    (first, _) = splits([slow])
    found = training_windows(first.training, WindowConfig())
    kept = training_windows(first.training, WindowConfig(horizon_m=2.0))
    assert len(found) > 2 * len(kept)
    assert np.median(found.travel_m) < 1


def test_training_horizons_are_kept():
    SEEN.clear()
    config = ComparisonConfig(training_horizons_m=(5.0,))
    compare([drive(4)], [Spied(MODELS["icr_symmetric"])], config=config)
    assert set(SEEN) == {2.0, 5.0}


def narrowest(compared, quantity):
    """Half of the narrowest interval of a difference."""
    intervals = [each.interval for each in compared.differences if each.quantity == quantity]
    return min(min(each.high - each.mean, each.mean - each.low) for each in intervals)


def test_intervals_in_translation_are_as_wide_as_a_yaw_may_be_off():
    run = drive(6, noise_m=0.01, gyroscope=True)
    measured, found = compare([run]), compare([emptied(run)])
    three_degrees = 1.96 * np.radians(3.0)
    assert narrowest(measured, "translation") < three_degrees < narrowest(found, "translation")
    assert narrowest(found, "rotation") < 10 * narrowest(measured, "rotation")
    assert any("intervals of differences in translation are wider" in note for note in found.notes)
