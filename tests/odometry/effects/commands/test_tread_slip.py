"""Slip by a tread's own motion, by closed forms."""

import numpy as np
import pytest

from odometry.effects.commands.tread_slip import SlipByAcceleration, SlipByDirection, SlipBySpeed
from odometry.models.inputs import Inputs

SPEEDS = np.array([[0.5, -2.0], [1.0, 0.1]])


def test_by_speed_it_grows_with_the_speed_of_its_own_tread():
    found = SlipBySpeed().tread_speeds(np.array([0.1]), Inputs(SPEEDS))
    np.testing.assert_allclose(found, [[0.475, -1.6], [0.9, 0.099]], atol=1e-15)


def test_by_direction_treads_that_turn_backward_are_scaled():
    found = SlipByDirection().tread_speeds(np.array([0.8]), Inputs(SPEEDS))
    np.testing.assert_array_equal(found, [[0.5, -1.6], [1.0, 0.1]])


def test_by_acceleration_a_ramp_loses_one_share_and_a_steady_speed_none():
    """Speeding up at 0.5 m/s^2, forward and backward; then braking; 0.2 of s^2/m."""
    time_s = 0.05 * np.arange(81)
    size = np.interp(time_s, [0, 1, 2, 3, 4], [0, 0, 0.5, 0.5, 0])
    inputs = Inputs(np.column_stack([size, -size]), time_s=time_s)
    shares = SlipByAcceleration().tread_speeds(np.array([0.2]), inputs)[1:-1] / np.where(
        inputs.tread_speeds_m_s[1:-1] == 0, 1, inputs.tread_speeds_m_s[1:-1]
    )
    ramp, steady, brake = (
        (time_s[1:-1] > first + 0.15) & (time_s[1:-1] < first + 0.8) for first in (1, 2, 3)
    )
    np.testing.assert_allclose(shares[ramp], 0.9, atol=1e-12)
    np.testing.assert_allclose(shares[steady], 1.0, atol=1e-12)
    np.testing.assert_allclose(shares[brake], 1.1, atol=1e-12)


@pytest.mark.parametrize("slip", [SlipBySpeed(), SlipByAcceleration()])
def test_a_gain_is_no_slip(slip):
    """An encoder that loses counts at speed, treads that are ahead in starts."""
    assert slip.is_meant(np.array([0.1]))
    assert not slip.is_meant(np.array([-0.1]))
