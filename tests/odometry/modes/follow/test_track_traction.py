from dataclasses import replace

import numpy as np
import pytest

from odometry.modes.follow.track import follow_modes
from odometry.modes.models.mode_set import ModeSet
from odometry.modes.models.traction import TractionModes
from odometry.modes.recorded.bank_inputs import BIAS_SIGMA_RAD_S
from tests.odometry.modes.mode_drives import (
    ROBOT,
    asked_twists,
    poses_and_yaw_rates,
    run_of_tables,
    table,
    wandering,
)

STEP_S, CHANGE = 0.02, 500


@pytest.fixture(scope="module")
def losing_traction():
    """Poses alone at 10 Hz: from 10 s on half of the turn is lost. Run, modes, last place."""
    rng, size = np.random.default_rng(6), 2 * CHANGE
    gains = np.zeros((2, 2, 3, 5))
    gains[:, :, 0, 0], gains[:, :, 2, 1] = 1.0, np.array([0.8, 0.4])[:, None]
    noise = np.array([1e-4, 1e-5, 1e-8]), np.array([1e-4, 1e-4, 25e-6, 1.0])
    modes = TractionModes(("none", "all"), gains, np.full(2, 0.1), ROBOT.track_width, *noise)
    treads = wandering(rng, size, STEP_S)
    asked = [asked_twists(of, treads, ROBOT.track_width) for of in gains]
    states = poses_and_yaw_rates(np.vstack([asked[0][:CHANGE], asked[1][CHANGE:]]), 0.1, STEP_S)
    t = STEP_S * np.arange(size)
    x, y, yaw = (states[::5, :3] + rng.normal(size=(size // 5, 3)) * [0.01, 0.01, 0.005]).T
    pose = {"t": t[::5], "x": x, "y": y, "yaw": np.angle(np.exp(1j * yaw))}
    odometry = {"t": t, "v_left": treads[:, 0], "v_right": treads[:, 1]}
    run = run_of_tables(odometry, pose=pose)
    return run, ModeSet(modes, np.full(2, 20.0)), states[-1, :2]


def test_traction_that_is_lost_is_recognised_within_seconds(losing_traction):
    run, mode_set, last = losing_traction
    track = follow_modes(run, mode_set)
    told = [np.flatnonzero(track.probabilities[:, mode] > 0.9)[0] for mode in (0, 1)]
    assert told[0] * STEP_S < 4.0
    assert 0.0 < (told[1] - CHANGE) * STEP_S < 4.0
    assert np.hypot(*(track.means[-1, :2] - last)) < 0.03


@pytest.mark.parametrize("late_s", [0.5, 4.0])
def test_poses_that_begin_late_do_not_mislead(losing_traction, late_s):
    run, mode_set, last = losing_traction
    whole, kept = run.pose.columns, run.pose.stamps_s >= late_s
    pose = table({name: column[kept] for name, column in whole.items()})
    track = follow_modes(replace(run, pose=pose), mode_set)
    assert np.nanmax(track.normalised_squared[:CHANGE]) < 8.0
    assert track.probabilities[:CHANGE, 1].max() < 0.9
    assert np.hypot(*(track.means[-1, :2] - last)) < 0.03


def test_a_bias_that_poses_confirm_is_no_reason_to_name_nothing(losing_traction):
    """A gyroscope that is off by six prior deviations: headings say the same."""
    run, mode_set, _ = losing_traction
    truth = run.pose["yaw"]
    rates = np.gradient(np.unwrap(truth), run.pose.stamps_s)
    biased = np.interp(run.odometry.stamps_s, run.pose.stamps_s, rates) + 6 * BIAS_SIGMA_RAD_S
    odometry = table({**run.odometry.columns, "gyro_z": biased})
    noise = mode_set.modes.measurement_variance * [1.0, 1.0, 1.0, 0.05**2]
    modes = replace(mode_set.modes, measurement_variance=noise)
    track = follow_modes(replace(run, odometry=odometry), replace(mode_set, modes=modes))
    assert track.means[-1, -1] > 3 * BIAS_SIGMA_RAD_S
    assert not track.gyroscope.bias_is_open[-1]
