"""The filter of pose and ICRs: where it starts, what it takes in, and which settings it has."""

import numpy as np
import pytest

from odometry.errors import ConfigError, EstimationError
from odometry.estimation.config import IcrEkfConfig
from tests.odometry.estimation.icr_ekf_drives import WIDTH, driven, filter_of, frame, table


def test_it_starts_at_the_pose_with_the_sensors_uncertainty():
    ekf = filter_of(terrains={"a": table(0.4, -0.3, 0.1, 0.02)}, yaw_sigma_rad=0.03)
    start = ekf.start(frame(5, (1, 2, 3)), "a")
    np.testing.assert_array_equal(start.mean, [1, 2, 3, 0.4, -0.3, 0.1, 0, 1, 1])
    sigmas = [0.02, 0.02, 0.03, 0.02, 0.02, 0.02, 0, 0, 0]
    np.testing.assert_allclose(start.covariance, np.diag(np.square(sigmas)))
    assert (start.stamp_s, start.terrain) == (5, "a")


@pytest.mark.parametrize("pose", [None, (np.nan, 0, 0), (0, 0, np.nan)])
def test_it_starts_at_the_origin_without_a_pose(pose):
    np.testing.assert_array_equal(filter_of().start(frame(0, pose), "a").mean[:3], [0, 0, 0])


def test_a_terrain_without_a_table_starts_from_the_broad_prior():
    start = filter_of().start(frame(0), "a")
    np.testing.assert_allclose(start.mean[3:6], [WIDTH / 2, -WIDTH / 2, 0])
    np.testing.assert_allclose(start.covariance[3:6, 3:6], (WIDTH / 2) ** 2 * np.eye(3))


@pytest.mark.parametrize("pose", [(np.nan, np.nan, np.nan), (np.inf, np.nan, np.nan)])
def test_a_pose_of_nothing_is_as_good_as_none(pose):
    ekf = filter_of()
    before = driven(ekf)
    with_nan = ekf.step(before, frame(3.1, pose), "a")
    without = ekf.step(before, frame(3.1), "a")
    np.testing.assert_array_equal(with_nan.mean, without.mean)
    np.testing.assert_array_equal(with_nan.covariance, without.covariance)
    assert with_nan.innovation is None


def test_slip_factors_multiply_the_measured_speeds():
    slipping = filter_of(terrains={"a": table(0.3, -0.3, 0, alpha_left=0.5, alpha_right=0.75)})
    plain = filter_of(terrains={"a": table(0.3, -0.3, 0)})
    moved = slipping.step(slipping.start(frame(0, speeds=(2, 4)), "a"), frame(0.5), "a")
    expected = plain.step(plain.start(frame(0, speeds=(1, 3)), "a"), frame(0.5), "a")
    np.testing.assert_allclose(moved.mean[:7], expected.mean[:7])
    np.testing.assert_array_equal(moved.alphas, [0.5, 0.75])


def test_without_tread_speeds_it_stays():
    ekf = filter_of()
    start = ekf.start(frame(0, (1, 2, 3), speeds=(np.nan, np.nan)), "a")
    np.testing.assert_array_equal(ekf.step(start, frame(1), "a").mean, start.mean)


@pytest.mark.parametrize("stamp_s", [np.nan, np.inf])
def test_a_stamp_that_is_no_number_is_refused(stamp_s):
    ekf = filter_of()
    with pytest.raises(EstimationError, match=f"the stamp {stamp_s}; expected a finite"):
        ekf.step(ekf.start(frame(0), "a"), frame(stamp_s), "a")
    with pytest.raises(EstimationError, match=f"the stamp {stamp_s}"):
        ekf.start(frame(stamp_s), "a")


@pytest.mark.parametrize("yaw", [np.pi - 0.01, -np.pi + 0.01, np.pi])
def test_yaw_wraps(yaw):
    """A pose at +-pi + 0.02 from a belief on the other side is a small innovation."""
    ekf = filter_of(gate_probability=1.0)
    start = ekf.start(frame(0, (0, 0, yaw), speeds=(0, 0)), "a")
    for shift in (0.02, -0.02):
        measured = np.angle(np.exp(1j * (yaw + shift)))
        after = ekf.step(start, frame(0.1, (0, 0, measured)), "a")
        assert after.innovation.residual[2] == pytest.approx(shift, abs=1e-12)
        assert -np.pi < after.mean[2] <= np.pi
        moved = np.angle(np.exp(1j * (after.mean[2] - yaw)))
        assert moved / shift == pytest.approx(0.75, abs=0.25)


def test_turning_on_the_spot_past_the_half_turn():
    """Whole turns with poses wrapped as sensors wrap them: no pose is ever refused."""
    ekf = filter_of(terrains={"a": table(0.25, -0.25, 0)})
    estimate = ekf.start(frame(0, (0, 0, 0), speeds=(-0.25, 0.25)), "a")
    for i in range(1, 200):
        yaw = np.angle(np.exp(0.1j * i))
        estimate = ekf.step(estimate, frame(0.1 * i, (0, 0, yaw), speeds=(-0.25, 0.25)), "a")
        assert estimate.innovation.accepted
    np.testing.assert_allclose(estimate.mean[3:6], [0.25, -0.25, 0], atol=1e-6)


@pytest.mark.parametrize("yaw", [-3, 3, 30])
def test_y_left_stays_above_y_right_under_violent_innovations(yaw, rng):
    ekf = filter_of(gate_probability=1.0, reset_sigma_widths=4)
    estimate = ekf.start(frame(0, (0, 0, 0)), "a")
    for i in range(1, 60):
        pose = rng.normal([0, 0, yaw], [50, 50, abs(yaw)])
        estimate = ekf.step(estimate, frame(0.1 * i, pose, rng.uniform(-2, 2, 2)), "a")
        assert estimate.mean[3] - estimate.mean[4] >= 0.1 * WIDTH - 1e-12
        assert np.all(np.isfinite(estimate.mean))


@pytest.mark.parametrize(
    ("name", "value"),
    [
        ("position_sigma_m", 0.0),
        ("yaw_sigma_rad", -1.0),
        ("yaw_sigma_rad", float("nan")),
        ("position_noise", -1e-9),
        ("icr_noise_widths", -1.0),
        ("reset_sigma_widths", 0.0),
        ("gate_probability", 0.0),
        ("gate_probability", 1.5),
        ("jump_probability", -1.0),
        ("gate_patience", 0),
        ("jump_window", 0),
    ],
)
def test_settings_without_meaning_are_refused(name, value):
    with pytest.raises(ConfigError, match=name):
        IcrEkfConfig(**{name: value})
