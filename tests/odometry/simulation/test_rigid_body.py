"""The constraint solver and the integrator against closed forms."""

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from odometry.simulation.drive import body_twist, pose_rate, runge_kutta_4

speeds = st.floats(-2.0, 2.0)
half_widths = st.floats(0.1, 1.0)


@given(v_left=speeds, v_right=speeds, left=half_widths, right=half_widths, x_icr=speeds)
def test_twist_is_that_of_the_closed_form(v_left, v_right, left, right, x_icr):
    """data/README.md: omega, v_x and v_y from y_left, y_right and x_icr."""
    v_x, v_y, omega = body_twist(np.array([v_left, v_right]), np.array([left, -right, x_icr]))
    assert omega == pytest.approx((v_right - v_left) / (left + right), abs=1e-9)
    assert v_x == pytest.approx((v_right * left + v_left * right) / (left + right), abs=1e-9)
    assert v_y == pytest.approx(-x_icr * omega, abs=1e-9)


def test_left_turn_on_the_spot():
    _, _, omega = body_twist(np.array([-0.3, 0.3]), np.array([0.4, -0.4, 0.0]))
    assert omega == pytest.approx(0.75)


@given(v_left=speeds, v_right=speeds, left=half_widths, right=half_widths, x_icr=speeds)
def test_mirrored_robot_has_the_mirrored_twist(v_left, v_right, left, right, x_icr):
    v_x, v_y, omega = body_twist(np.array([v_left, v_right]), np.array([left, -right, x_icr]))
    mirrored = body_twist(np.array([v_right, v_left]), np.array([right, -left, x_icr]))
    np.testing.assert_allclose(mirrored, [v_x, -v_y, -omega], atol=1e-9)


def test_coinciding_icrs_contradict_each_other():
    with pytest.raises(np.linalg.LinAlgError):
        body_twist(np.array([0.1, 0.2]), np.array([0.3, 0.3, 0.0]))


def turning(pose):
    """A twist that depends on the pose, so that no step size is exact."""
    return pose_rate(pose, np.array([0.7, 0.2, 1.0 + 0.5 * np.sin(3 * pose[0])]))


def test_convergence_is_of_the_fourth_order():
    start = np.array([0.1, 0.2, 0.3])
    reference = runge_kutta_4(turning, start, 2.0, 4096)
    steps = np.array([16, 32, 64, 128])
    errors = [np.abs(runge_kutta_4(turning, start, 2.0, n) - reference).max() for n in steps]
    orders = -np.diff(np.log(errors)) / np.diff(np.log(steps))
    np.testing.assert_allclose(orders, 4.0, atol=0.3)


def test_rate_is_turned_into_the_world():
    """Heading along +y, forward is +y and left is -x."""
    rate = pose_rate(np.array([5.0, 6.0, np.pi / 2]), np.array([0.5, 0.1, 0.2]))
    np.testing.assert_allclose(rate, [-0.1, 0.5, 0.2], atol=1e-12)
