"""How far treads can be off: variances by hand, and what finer steps must not change."""

import math

import numpy as np
import pytest

from odometry.estimation.config import IcrEkfConfig
from odometry.estimation.noise_scale import (
    BY_SPEED,
    BY_TURN,
    CORRELATED_S,
    STANDING_RAD_S,
    huber_factor,
    tread_variance,
    velocity_variances,
    width_sigma_m,
)
from odometry.estimation.transition import Y_LEFT, Y_RIGHT

WIDTH_M, STEP_S = 0.8, 0.1
CONFIG = IcrEkfConfig(
    slip_noise=0.3,
    position_noise=0.02,
    yaw_noise=0.05,
    gyro_noise=0.01,
    velocity_sigma_m_s=0.04,
    yaw_rate_sigma_rad_s=0.03,
)


def by_treads(left=0.0, right=0.0, yaw_rate=0.0, slip_scale=1.0, step_s=STEP_S):
    return tread_variance(np.array([left, right]), yaw_rate, WIDTH_M, slip_scale, step_s)


def test_at_rest_it_is_what_holds_at_rest_alone():
    assert by_treads() == pytest.approx(STANDING_RAD_S**2 * CORRELATED_S / STEP_S)


@pytest.mark.parametrize(("left", "right"), [(1.0, 3.0), (-1.0, 3.0), (3.0, -1.0), (-3.0, -1.0)])
def test_speed_counts_by_its_mean_size_over_the_width(left, right):
    more = by_treads(left, right) - by_treads()
    assert more == pytest.approx((BY_SPEED * 2.0 / WIDTH_M) ** 2 * CORRELATED_S / STEP_S)


def test_the_scale_of_slip_is_on_what_comes_of_speed_alone():
    more = by_treads(2.0, 2.0, 0.7, slip_scale=5.0) - by_treads(2.0, 2.0, 0.7)
    assert more == pytest.approx(4.0 * (by_treads(2.0, 2.0) - by_treads()))


@pytest.mark.parametrize("yaw_rate", [0.7, -0.7])
def test_turning_adds_a_share_of_the_turn(yaw_rate):
    more = by_treads(yaw_rate=yaw_rate) - by_treads()
    assert more == pytest.approx((BY_TURN * 0.7) ** 2 * CORRELATED_S / STEP_S)


def test_the_angle_turned_is_as_uncertain_however_finely_time_is_cut():
    """Variances of the angles of equal steps, which are independent, add up."""
    whole = by_treads(1.0, 2.0, 0.3, step_s=0.4) * 0.4**2
    parts = 8 * by_treads(1.0, 2.0, 0.3, step_s=0.05) * 0.05**2
    assert parts == pytest.approx(whole)


def test_the_width_is_as_uncertain_as_a_difference(rng):
    root = rng.normal(size=(9, 9))
    contrast = np.zeros(9)
    contrast[[Y_LEFT, Y_RIGHT]] = 1.0, -1.0
    covariance = root @ root.T
    assert width_sigma_m(covariance) == pytest.approx(np.linalg.norm(root.T @ contrast))
    assert width_sigma_m(np.ones((9, 9))) == 0.0


@pytest.mark.parametrize(
    ("residual", "factor"), [(0.0, 1.0), (0.2, 1.0), (-0.4, 4.0), (0.4, 4.0), (0.3, 2.25)]
)
def test_beyond_two_deviations_the_noise_grows_to_two_deviations(residual, factor):
    """Its deviation is 0.1; 4 and 2.25 are the squares of 0.4 and 0.3 over 0.2."""
    assert huber_factor(residual, 0.01) == pytest.approx(factor)


def test_a_number_without_variance_keeps_its_noise():
    assert huber_factor(0.3, 0.0) == 1.0


def velocity(yaw_rate, slip_scale=1.0):
    return velocity_variances(
        CONFIG,
        np.array([-1.0, 3.0]),
        track_width=WIDTH_M,
        slip_scale=slip_scale,
        step_s=STEP_S,
        yaw_rate=yaw_rate,
    )


@pytest.mark.parametrize("slip_scale", [1.0, 4.0])
def test_measured_velocities_by_hand(slip_scale):
    """Slip 0.3^2 x 2 m/s; of the position 0.02^2, of the yaw 0.05^2, over a step of 0.1 s."""
    slip = 0.09 * slip_scale * 2.0
    along, across, turn = velocity(math.nan, slip_scale)
    assert along == across == pytest.approx(0.04**2 + (slip + 0.02**2) / 0.1)
    assert turn == pytest.approx(0.03**2 + (slip / 0.8**2 + 0.05**2) / 0.1)


def test_where_a_gyroscope_turns_the_robot_its_noise_counts():
    along, _, turn = velocity(0.2)
    assert along == pytest.approx(velocity(math.nan)[0])
    assert turn == pytest.approx(0.03**2 + 0.01**2 / 0.1)
