"""A gyroscope that turns the robot, and what it teaches with poses and without."""

import numpy as np
import pytest

from odometry.estimation.config import IcrEkfConfig
from tests.odometry.estimation.sensor_drives import (
    ALPHAS,
    ICRS,
    drive,
    estimates_of,
    frames_of,
    noisy_poses,
    standing,
)

BIAS = 0.016  # [rad/s], as large as one of a real robot


def test_without_poses_it_teaches_the_width_of_the_treads():
    """Slip factors cannot be estimated without poses: the width that it learns is for alpha = 1.

    A yaw rate of the treads is the difference of speeds over (y_left - y_right) / alpha.
    """
    driven = drive()
    estimate = estimates_of(frames_of(driven, yaw_rates=driven.yaw_rates_rad_s))[-1]
    y_left, y_right = estimate.mean[3:5]
    alpha = estimate.alphas.mean()
    expected = (ICRS[0] - ICRS[1]) / np.mean(ALPHAS)
    assert (y_left - y_right) / alpha == pytest.approx(expected, rel=0.03)
    before = 0.6 / 1.0
    assert abs(before - expected) > 0.3 * expected


def test_without_poses_slip_is_not_made_up_where_treads_spin():
    """On ice treads turn much and the robot little: the width says so, the slip factors cannot."""
    driven = drive(120.0)
    last = estimates_of(frames_of(driven, yaw_rates=0.2 * driven.yaw_rates_rad_s))[-1]
    np.testing.assert_allclose(last.alphas, 1.0, atol=1e-9)
    assert np.sqrt(np.diag(last.covariance)[7:]).min() > 0.04


def test_with_poses_it_teaches_everything(rng):
    driven = drive(120.0)
    frames = frames_of(
        driven, poses=noisy_poses(driven, rng), yaw_rates=driven.yaw_rates_rad_s + BIAS
    )
    last = estimates_of(frames)[-1]
    np.testing.assert_allclose(last.mean[3:6], ICRS, atol=0.04)
    np.testing.assert_allclose(last.alphas, ALPHAS, atol=0.02)
    assert last.gyro_bias_rad_s == pytest.approx(BIAS, abs=0.003)
    assert np.sqrt(last.covariance[6, 6]) < 0.005


def test_standing_still_finds_the_bias():
    driven = drive(10.0, speeds_of=standing)
    last = estimates_of(frames_of(driven, yaw_rates=driven.yaw_rates_rad_s + BIAS))[-1]
    assert last.gyro_bias_rad_s == pytest.approx(BIAS, abs=0.002)
    assert np.sqrt(last.covariance[6, 6]) < 0.005


def test_where_it_is_silent_the_treads_turn_the_robot():
    driven = drive(20.0)
    rates = driven.yaw_rates_rad_s.copy()
    rates[100:] = np.nan
    frames = frames_of(driven, yaw_rates=rates)
    with_gyroscope, without = estimates_of(frames), estimates_of(frames_of(driven))
    for k in (150, 200):
        moved = with_gyroscope[k].mean[2] - with_gyroscope[k - 1].mean[2]
        mean = with_gyroscope[k - 1].mean
        left, right = mean[7:] * driven.speeds_m_s[k - 1]
        assert moved == pytest.approx((right - left) / (mean[3] - mean[4]) * 0.1, abs=1e-9)
    assert np.isnan(without[5].yaw_rate_rad_s)


def test_it_can_be_left_out():
    driven = drive(10.0)
    frames = frames_of(driven, yaw_rates=driven.yaw_rates_rad_s + 0.3)
    config = IcrEkfConfig(use_gyroscope=False)
    ours = estimates_of(frames, config)[-1]
    plain = estimates_of(frames_of(driven), config)[-1]
    np.testing.assert_array_equal(ours.mean, plain.mean)
    np.testing.assert_array_equal(ours.covariance, plain.covariance)
    assert ours.covariance[6, 6] == 0


def test_a_velocity_of_yaw_alone_teaches_the_width_too():
    driven = drive()
    velocities = np.full((len(driven.stamps_s), 3), np.nan)
    velocities[:, 2] = driven.yaw_rates_rad_s
    last = estimates_of(frames_of(driven, velocities=velocities))[-1]
    width = (last.mean[3] - last.mean[4]) / last.alphas.mean()
    assert width == pytest.approx((ICRS[0] - ICRS[1]) / np.mean(ALPHAS), rel=0.05)


def measured_velocities(driven, rng):
    """vx, vy and wz (N, 3) of a drive, with noise."""
    omega = driven.yaw_rates_rad_s
    effective = np.vstack([driven.speeds_m_s[:1], driven.speeds_m_s[:-1]]) * ALPHAS
    velocities = np.column_stack([effective[:, 0] + ICRS[0] * omega, -ICRS[2] * omega, omega])
    return velocities + rng.normal(0, 0.01, velocities.shape)


def test_a_whole_velocity_teaches_slip_and_the_icr_ahead(rng):
    driven = drive(60.0)
    velocities = measured_velocities(driven, rng)
    last = estimates_of(frames_of(driven, velocities=velocities, yaw_rates=driven.yaw_rates_rad_s))[
        -1
    ]
    np.testing.assert_allclose(last.mean[3:6], ICRS, atol=0.06)
    np.testing.assert_allclose(last.alphas, ALPHAS, atol=0.04)


def test_single_velocities_far_off_move_no_icr(rng):
    driven = drive(60.0)
    velocities = measured_velocities(driven, rng)
    velocities[len(velocities) // 2 :: 40] += [5.0, -3.0, 2.0]
    last = estimates_of(frames_of(driven, velocities=velocities, yaw_rates=driven.yaw_rates_rad_s))[
        -1
    ]
    np.testing.assert_allclose(last.mean[3:6], ICRS, atol=0.06)
    np.testing.assert_allclose(last.alphas, ALPHAS, atol=0.04)
