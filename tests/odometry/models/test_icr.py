"""Constant tread ICRs by hand; what every model keeps is in tests/contracts."""

import numpy as np
import pytest

from odometry.errors import ParameterError
from odometry.models.icr import Icr
from odometry.models.inputs import Inputs

MODEL = Icr()
BY_HAND = {"y_left": 0.5, "y_right": -0.3, "x_icr": 0.1}


@pytest.mark.parametrize("y_right", [0.2, 0.3])
def test_y_left_exceeds_y_right(y_right):
    with pytest.raises(ParameterError, match="y_left"):
        MODEL.pack({"y_left": 0.2, "y_right": y_right, "x_icr": 0.0})


def test_an_asymmetric_twist_by_hand():
    """D = 0.8; omega = 1 / 0.8, v_x = (1.5*0.5 + 0.5*0.3) / 0.8, v_y = -0.1 omega."""
    twist = MODEL.twist(MODEL.pack(BY_HAND), Inputs(np.array([0.5, 1.5])))
    np.testing.assert_allclose(twist, [1.125, -0.125, 1.25], rtol=1e-15)


def test_slip_factors_multiply_the_tread_speeds():
    slipping = MODEL.pack({**BY_HAND, "alpha_left": 0.8, "alpha_right": 0.9})
    np.testing.assert_allclose(
        MODEL.twist(slipping, Inputs(np.array([1.0, 2.0]))),
        MODEL.twist(MODEL.pack(BY_HAND), Inputs(np.array([0.8, 1.8]))),
    )


def test_at_each_tread_icr_the_ground_speed_is_the_tread_speed(rng):
    """The definition of a tread ICR: v_x - omega y_left = v_left, and v_y + omega x_icr = 0."""
    for y_left, half, x_icr in rng.uniform([0.1, 0.1, -0.3], [0.6, 0.6, 0.3], (20, 3)):
        v_left, v_right = rng.uniform(-2, 2, 2)
        values = MODEL.pack({"y_left": y_left, "y_right": -half, "x_icr": x_icr})
        v_x, v_y, omega = MODEL.twist(values, Inputs(np.array([v_left, v_right])))
        np.testing.assert_allclose(
            [v_x - omega * y_left, v_x + omega * half, v_y + omega * x_icr],
            [v_left, v_right, 0],
            atol=1e-13,
        )


def test_tread_speeds_by_hand():
    """1.125 - 1.25 * 0.5 = 0.5 and 1.125 + 1.25 * 0.3 = 1.5, each over its slip factor."""
    values = MODEL.pack({**BY_HAND, "alpha_left": 0.5, "alpha_right": 0.75})
    speeds = MODEL.tread_speeds(values, np.array(1.125), np.array(1.25))
    np.testing.assert_allclose(speeds, [1.0, 2.0], rtol=1e-15)
