"""Feel as a source of terrain: alone, and as place labels beneath the robot beside the camera."""

from dataclasses import replace

import numpy as np
import pytest

from odometry.errors import ConfigError
from odometry.feel.labels.follow import follow_feel
from odometry.recording.run import Run
from odometry.tables.table import Table
from terrain.config import Config
from terrain.main_job import run_odometry
from terrain.switch.feel_labels import FeelLabels, widened
from terrain.switch.switch import SwitchConfig
from tests.odometry.feel.feel_drives import drive, model_of_three

NAMES = ["tiles", "gravel", "snow"]


@pytest.fixture(scope="module")
def model():
    return model_of_three()


def joined(first, second):
    """One run after another."""
    begin_s = first.odometry.stamps_s[-1] + 0.1

    def both(one, other):
        later = {name: of + begin_s * (name == "t") for name, of in other.columns.items()}
        columns = {name: np.concatenate([of, later[name]]) for name, of in one.columns.items()}
        return Table(one.file, columns, np.arange(2, 2 + len(columns["t"])))

    imu = both(first.imu, second.imu)
    settings = {"robot": {"track_width": 0.5}}
    odometry = both(first.odometry, second.odometry)
    return Run(first.folder, first.robot, settings, odometry, imu=imu), begin_s


def test_what_is_felt_brings_a_terrain_into_force(model):
    run, begin_s = joined(drive("gravel", 60), drive("snow", 61))
    result = run_odometry(run, feel=model, terrain="gravel")
    assert result.source == "feel"
    (change,) = result.changes
    assert change.terrain == "snow"
    assert begin_s < change.stamp_s < begin_s + 12.0


def test_sights_do_not_overlap_and_lie_beneath_the_robot(model):
    felt = follow_feel(drive("snow", 62), model)
    place_labels = FeelLabels.of(felt, ("snow", "mud"))
    assert np.diff(place_labels.known_s).min() >= felt.windows.window_s - 1e-9
    pose = np.array([3.0, 1.0, np.pi / 2])
    (first, *_) = place_labels.between(-np.inf, 6.0, pose, 4.0)
    assert first.label == "snow"
    assert first.place == pytest.approx(pose[:2])
    assert set(first.probabilities) == {*NAMES, "mud"}
    assert not list(place_labels.between(6.0, 6.0, pose, 4.0))


def test_what_fits_no_terrain_is_no_sight(model):
    assert len(FeelLabels.of(follow_feel(drive("grates", 64), model)).known_s) == 0


def test_a_terrain_that_a_source_does_not_know_gets_the_mean():
    wider = widened({"a": 0.9, "b": 0.1}, ("b", "c"))
    assert sum(wider.values()) == pytest.approx(1.0)
    assert wider["a"] / wider["b"] == pytest.approx(9.0)
    assert wider["c"] == pytest.approx(1 / 3)


def test_labels_in_a_row_are_not_weighed_with_feel(model, across_run, classifier):
    config = replace(Config(), switch=SwitchConfig(labels_in_row=2))
    with pytest.raises(ConfigError, match="labels_in_row"):
        run_odometry(across_run, model=classifier, feel=model, config=config)


def test_feel_needs_a_model(across_run):
    with pytest.raises(ConfigError, match="identify-feel"):
        run_odometry(across_run, source="feel")
