"""The step of the state against finite differences, Chen's equation and fine integration."""

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from odometry.estimation.transition import process_noise, transition
from odometry.models.icr import icr_twist_jacobian

length = st.floats(-20, 20)
speed = st.floats(-2, 2)
icrs = st.tuples(st.floats(0.2, 1), st.floats(-1, -0.2), st.floats(-0.5, 0.5))
states = st.tuples(length, length, st.floats(-3.2, 3.2), icrs).map(
    lambda s: np.array([*s[:3], *s[3]])
)
tread_speeds = (
    st.tuples(speed, speed)
    | speed.map(lambda v: (v, v))
    | st.tuples(speed, st.floats(-1e-4, 1e-4)).map(lambda s: (s[0], s[0] + s[1]))
).map(np.array)
steps_s = st.floats(0.001, 0.5)


def difference(one, other):
    """State differences, yaw on the circle."""
    delta = one - other
    delta[2] = np.angle(np.exp(1j * delta[2]))
    return delta


@given(states, tread_speeds, steps_s)
def test_jacobian_is_the_derivative(state, speeds, step_s):
    """Central differences of 1e-6 around positions of 20 m: rounding below 1e-8."""
    h = 1e-6
    columns = [
        difference(
            transition(state + h * e, speeds, step_s)[0],
            transition(state - h * e, speeds, step_s)[0],
        )
        / (2 * h)
        for e in np.eye(6)
    ]
    jacobian = transition(state, speeds, step_s)[1]
    np.testing.assert_allclose(jacobian, np.column_stack(columns), rtol=1e-6, atol=5e-8)


@given(states, tread_speeds)
def test_equation_10_as_the_conventions_correct_it(state, speeds):
    """In Chen's own x_G = -x_icr; the derivative by x_icr is that by x_G with its sign changed."""
    theta, y_l, y_r, x_g = state[2], state[3], state[4], -state[5]
    c, s, width = np.cos(theta), np.sin(theta), y_l - y_r
    by_chens_icrs = ((speeds[0] - speeds[1]) / width**2) * np.array(
        [
            [y_r * c - x_g * s, -y_l * c + x_g * s, s * width],
            [y_r * s + x_g * c, -y_l * s - x_g * c, -c * width],
            [1, -1, 0],
        ]
    )
    to_world = np.array([[c, -s, 0], [s, c, 0], [0, 0, 1]])
    ours = to_world @ icr_twist_jacobian(state[3:], speeds)
    np.testing.assert_allclose(ours * [1, 1, -1], by_chens_icrs, rtol=0, atol=1e-11)
    step_s = 1e-6
    in_the_limit = transition(state, speeds, step_s)[1][:3, 3:] / step_s
    np.testing.assert_allclose(in_the_limit * [1, 1, -1], by_chens_icrs, rtol=1e-4, atol=1e-3)


@given(states, tread_speeds, steps_s, st.integers(2, 9))
def test_splitting_a_step_changes_nothing(state, speeds, step_s, parts):
    whole, jacobian = transition(state, speeds, step_s)
    split, product = state, np.eye(6)
    for _ in range(parts):
        split, part = transition(split, speeds, step_s / parts)
        product = part @ product
    np.testing.assert_allclose(difference(split, whole), 0, atol=1e-11)
    np.testing.assert_allclose(product, jacobian, rtol=0, atol=1e-9)


@given(states, tread_speeds, steps_s)
def test_icrs_stay(state, speeds, step_s):
    np.testing.assert_array_equal(transition(state, speeds, step_s)[0][3:], state[3:])


def test_a_step_of_no_time_changes_nothing():
    state = np.array([1, 2, 3, 0.4, -0.3, 0.1])
    after, jacobian = transition(state, np.array([1.0, 2.0]), 0.0)
    np.testing.assert_allclose(after, state, atol=1e-15)
    np.testing.assert_array_equal(jacobian, np.eye(6))


DENSITY = np.array([1e-4, 1e-4, 1e-3, 1e-5, 1e-5, 1e-5])


def integrated_noise(state, speeds, step_s, parts=400):
    """The integral of F(s) Q F(s)^T by midpoints, F from s to the end of the step."""
    total = np.zeros((6, 6))
    for i in range(parts):
        middle, _ = transition(state, speeds, step_s * (i + 0.5) / parts)
        to_end = transition(middle, speeds, step_s * (parts - i - 0.5) / parts)[1]
        total += to_end @ np.diag(DENSITY) @ to_end.T * step_s / parts
    return total


@pytest.mark.parametrize("speeds", [(0.5, 0.5), (0.2, 0.9), (-0.5, 0.5)])
def test_process_noise_is_the_integral_to_second_order(speeds):
    """Halving the step divides the trapezium rule's error by eight: its order is dt^3 a step."""
    state = np.array([0, 0, 0.7, 0.4, -0.3, 0.1])
    errors = []
    for step_s in (0.2, 0.1):
        jacobian = transition(state, np.array(speeds), step_s)[1]
        noise = process_noise(jacobian, DENSITY, step_s)
        np.testing.assert_allclose(noise, noise.T, rtol=1e-12)
        errors.append(np.abs(noise - integrated_noise(state, np.array(speeds), step_s)).max())
    assert errors[0] < 1e-5
    assert 6.5 < errors[0] / errors[1] < 9.5
