"""What half of a step adds to the covariance, beside the settings."""

import numpy as np
import pytest

from odometry.estimation.config import IcrEkfConfig
from odometry.estimation.prediction import GAP_DENSITY, ProcessNoise
from odometry.estimation.transition import GYRO_BIAS, X_ICR, Y_LEFT, YAW, X, Y

WIDTH_M = 0.5
CONFIG = IcrEkfConfig()
SLIP = CONFIG.slip_noise**2


def added(speeds=(0.4, 0.4), step_s=0.2, **changes):
    """Variances (9,) of half a step, by treads unless given otherwise."""
    how = {"slip_scale": 1.0, "by_gyroscope": False, "in_gap": False} | changes
    covariance = ProcessNoise(CONFIG, WIDTH_M).over_half(np.array(speeds), step_s, **how)
    np.testing.assert_array_equal(covariance, np.diag(np.diag(covariance)))
    return np.diag(covariance)


@pytest.mark.parametrize("speeds", [(0.4, 0.4), (-0.4, 0.4), (-0.4, -0.4), (0.8, 0.0)])
def test_slip_grows_with_the_way_that_the_treads_make(speeds):
    """On the spot as much as straight ahead."""
    found = added(speeds)
    assert found[X] == found[Y] == pytest.approx((CONFIG.position_noise**2 + 0.4 * SLIP) * 0.1)
    assert found[YAW] == pytest.approx((CONFIG.yaw_noise**2 + 0.4 * SLIP / WIDTH_M**2) * 0.1)


def test_a_robot_that_stands_does_not_slip_and_a_scale_is_of_slip_alone():
    still = added((0.0, 0.0), slip_scale=9.0)
    assert still[X] == pytest.approx(CONFIG.position_noise**2 * 0.1)
    assert added(slip_scale=9.0)[X] - still[X] == pytest.approx(9.0 * 0.4 * SLIP * 0.1)


def test_a_gyroscope_turns_the_robot_with_its_own_noise():
    found = added(by_gyroscope=True)
    assert found[YAW] == pytest.approx(CONFIG.gyro_noise**2 * 0.1)
    assert found[X] == added()[X]


def test_in_a_gap_all_may_happen_but_to_a_yaw_that_is_measured():
    by_treads, by_gyroscope = (
        added(in_gap=True, by_gyroscope=of) - added(by_gyroscope=of) for of in (False, True)
    )
    of_place, of_yaw = GAP_DENSITY
    np.testing.assert_allclose(by_treads[:3], 0.1 * np.array([of_place, of_place, of_yaw]))
    np.testing.assert_allclose(by_gyroscope[:3], 0.1 * np.array([of_place, of_place, 0.0]))
    np.testing.assert_array_equal(by_treads[3:], 0.0)


def test_icrs_and_the_bias_wander_with_time():
    found, walking = added(), added(bias_walk=3.0)
    for place in (Y_LEFT, X_ICR):
        assert found[place] == pytest.approx((CONFIG.icr_noise_widths * WIDTH_M) ** 2 * 0.1)
    assert found[GYRO_BIAS] == pytest.approx(CONFIG.bias_noise**2 * 0.1)
    assert walking[GYRO_BIAS] == pytest.approx(9.0 * found[GYRO_BIAS])
    np.testing.assert_array_equal(np.delete(walking, GYRO_BIAS), np.delete(found, GYRO_BIAS))


def test_it_is_linear_in_time():
    np.testing.assert_allclose(added(step_s=0.6), 3.0 * added(step_s=0.2))
