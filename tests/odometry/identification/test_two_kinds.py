"""A terrain that alternates within a run is found; a run of one terrain is not divided."""

from dataclasses import replace

import numpy as np
import pytest

from odometry.identification.identify import identify
from odometry.identification.start import SolverConfig
from odometry.identification.two_kinds import LEAST_WINDOWS, two_kinds
from odometry.recording.run import Run
from odometry.windows.config import WindowConfig

CONFIG = WindowConfig(position_sigma_m=0.01, yaw_sigma_rad=0.005)
PERIOD_S = 12.0  # of the alternation


@pytest.fixture(scope="module")
def recorded(synthetic, tmp_path_factory):
    """A run of 120 s with the noise of stated poses."""
    rng = np.random.default_rng(8)
    odometry = synthetic.commands(rng, 1200)
    folder = tmp_path_factory.mktemp("kinds") / "run"
    twist = synthetic.icr_twist(synthetic.icrs)
    run = Run.read(synthetic.write(folder, odometry, np.arange(0, 119.5, 0.2), twist))
    return synthetic.noisy(run, rng, 0.01, 0.005)


def alternating(run, factor):
    """What the encoders say is larger by a factor every other time: slip factors shrink so."""
    factors = np.where(is_second(run.odometry.stamps_s), factor, 1.0)
    speeds = {name: run.odometry[name] * factors for name in ("v_left", "v_right")}
    return replace(run, odometry=replace(run.odometry, columns={**run.odometry.columns, **speeds}))


def is_second(stamps_s):
    return stamps_s // PERIOD_S % 2 == 1


def found_in(*runs, model="icr"):
    found = identify(runs, model, window_config=CONFIG, solver_config=SolverConfig(starts=1))
    (of_terrain,) = found.terrains.values()
    return of_terrain


@pytest.mark.parametrize("model", ["icr", "icr_symmetric"])
def test_a_run_of_one_terrain_is_not_divided(recorded, model):
    assert found_in(recorded, model=model).kinds is None


def test_two_that_alternate_are_told_apart_with_their_times(recorded):
    found = found_in(alternating(recorded, 1.4))
    assert found.halves.note() is None  # either half holds both
    factors = [
        fit.values["alpha_left"] for fit in (found.kinds.pair.first, found.kinds.pair.second)
    ]
    # windows across a change hold both
    assert max(factors) == pytest.approx(1.4 * min(factors), rel=0.1)
    middle_s = found.fit.windows.start_s + 1.0
    apart = np.mean(found.kinds.is_second == is_second(middle_s))
    assert max(apart, 1 - apart) > 0.8
    assert found.kinds.less < 0.3
    assert f"{1 / found.kinds.less:.1f} times less than with one" in found.mixed
    assert "windows that start at run " in found.mixed
    assert "column terrain" in found.mixed


def test_a_small_change_is_no_other_kind(recorded):
    assert found_in(alternating(recorded, 1.01)).kinds is None


def test_few_windows_are_not_divided(recorded):
    """Two sets of five parameters explain a few windows whatever they are."""
    short = alternating(recorded, 1.4)
    rows = np.flatnonzero(short.odometry.stamps_s < 3 * PERIOD_S)
    found = found_in(replace(short, odometry=short.odometry.rows(rows)))
    assert len(found.fit.windows) < LEAST_WINDOWS
    assert found.kinds is None


def test_nothing_is_fitted_to_few_windows(recorded):
    whole = found_in(alternating(recorded, 1.4)).fit
    few = whole.windows.where(np.arange(len(whole.windows)) < LEAST_WINDOWS - 1)

    def fit_to(*_):
        pytest.fail("a part was fitted")

    assert two_kinds(few, fit_to, whole) is None
