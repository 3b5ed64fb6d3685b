"""Traction modes: noise of steps, lag of treads, and the covariance at the start."""

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from hypothesis.extra.numpy import arrays

from odometry.errors import RunFolderError
from odometry.modes.models.response import lagged
from odometry.modes.recorded.bank_inputs import BIAS_SIGMA_RAD_S, BIAS_WALK_RAD2_S3
from tests.odometry.modes.mode_drives import run_of_tables
from tests.odometry.modes.traction_examples import MODES


def travel_noise(model):
    """Of place and yaw after 0.1 s at 2 m/s backward on the left and 4 m/s on the right: 0.3 m."""
    noise = model.process_noise(np.zeros((3, 5)), np.array([-2.0, 4.0]), 0.1)
    np.testing.assert_array_equal(noise, noise * np.eye(5))
    np.testing.assert_allclose(noise[:, 4, 4], 0.1 * BIAS_WALK_RAD2_S3)
    return np.diagonal(noise[:, :3, :3], axis1=1, axis2=2)


def test_noise_grows_with_wheel_travel():
    np.testing.assert_allclose(travel_noise(MODES.model()), [[6e-4, 6e-4, 1.5e-4]] * 3)


@pytest.mark.parametrize("step_s", [0.01, 0.05])
def test_in_the_long_run_the_yaw_rate_is_off_by_its_variance(step_s):
    model, u = MODES.model(), np.array([0.3, 0.5])
    variances = np.zeros(3)
    for _ in range(1000):
        noise = model.process_noise(np.zeros((3, 5)), u, step_s)
        jacobian = model.transition_jacobian(np.zeros((3, 5)), u, step_s)
        variances = jacobian[:, 3, 3] ** 2 * variances + noise[:, 3, 3]
    np.testing.assert_allclose(variances, 1e-4)


def test_rough_treads_add_to_all_noise_but_that_of_poses():
    model = MODES.model(0.5)
    np.testing.assert_allclose(travel_noise(model), [[9e-4, 9e-4, 2.25e-4]] * 3)
    expected = np.diag([4e-4, 4e-4, 1e-4, 1.5e-3])
    np.testing.assert_allclose(model.measurement_covariance, expected)


def test_treads_are_rough_while_they_speed_up_by_the_square():
    """0.5 m/s^2 on the left, 2 on the right, at first since less than 0.2 s; 2 for each square."""
    t = 0.1 * np.arange(30)
    odometry = {"t": t, "v_left": 0.5 * t, "v_right": -2.0 * t}
    pose = {"t": t + 0.05, "x": t, "y": t, "yaw": t}
    signals = MODES.signals(run_of_tables(odometry, pose=pose))
    assert len(signals) == 59
    settled = MODES.roughness(signals)[5:]
    np.testing.assert_allclose(settled, 2.0 * 2.0**2)
    assert MODES.roughness(signals)[0] == 0.0


@given(arrays(float, 40, elements=st.floats(-2, 2)), st.sampled_from([0.0, 0.05, 0.4]))
def test_a_lag_follows_as_a_loop_does(values, lag_s):
    step_s, followed = 0.02, [values[0]]
    for value in values[:-1]:
        lasting = np.exp(-step_s / max(lag_s, 1e-3))
        followed.append(followed[-1] * lasting + value * (1 - lasting))
    found = lagged(values, step_s * np.arange(40) + 7.0, lag_s)
    np.testing.assert_allclose(found, followed, atol=1e-10)


def test_a_lag_over_stamps_merged_from_two_clocks():
    """A step of 1 at 1 s, sampled at uneven stamps: 1 - exp(-(t - 1) / lag)."""
    stamps_s = np.union1d(np.arange(0, 3, 0.02), np.arange(0.007, 3, 0.1))
    found = lagged((stamps_s >= 1.0).astype(float), stamps_s, 0.3)
    expected = np.where(stamps_s > 1.0, 1 - np.exp(-(stamps_s - 1.0) / 0.3), 0.0)
    np.testing.assert_allclose(found, expected, atol=0.02 / 0.3)


def started(t, x):
    """Mean and covariance at the start, of treads at 1 and 2 m/s and these poses."""
    pose = {"t": t, "x": np.array(x), "y": t, "yaw": t + 1}
    odometry = {"t": t, "v_left": np.ones(len(t)), "v_right": np.full(len(t), 2.0)}
    return MODES.start(MODES.signals(run_of_tables(odometry, pose=pose)))


def test_it_starts_standing_at_the_first_pose():
    mean, covariance = started(np.array([0.0, 0.1]), [2.0, 3.0])
    np.testing.assert_allclose(mean, [2.0, 0.0, 1.0, 0.0, 0.0])
    expected = np.diag([4e-4, 4e-4, 1e-4, 0.0, BIAS_SIGMA_RAD_S**2])
    np.testing.assert_array_equal(covariance, expected)


def test_a_first_pose_that_comes_late_is_less_certain():
    """The first whole one after 0.4 s: 0.6 m of wheel travel, a turn of 0.8 rad asked for."""
    mean, covariance = started(np.array([0.0, 0.1, 0.4, 0.5]), [np.nan, np.nan, 2.0, 3.0])
    np.testing.assert_allclose(mean, [2.0, 0.4, 1.4, 0.0, 0.0])
    expected = [4e-4 + 0.36, 4e-4 + 0.36, 1e-4 + 0.64, 0.0, BIAS_SIGMA_RAD_S**2]
    np.testing.assert_allclose(covariance, np.diag(expected))


def test_poses_of_which_none_is_whole_are_refused():
    with pytest.raises(RunFolderError, match="drive: no pose"):
        started(np.array([0.0, 0.1]), [np.nan, np.nan])
