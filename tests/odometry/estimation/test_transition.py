"""The step of the state against finite differences, Chen's equation and a model's own arc."""

import numpy as np
from hypothesis import given
from hypothesis import strategies as st

from odometry.estimation.transition import STATES, moved_pose, transition
from odometry.geometry import se2
from odometry.models.icr import icr_twist, icr_twist_jacobian

length = st.floats(-20, 20)
speed = st.floats(-2, 2)
icrs = st.tuples(st.floats(0.2, 1), st.floats(-1, -0.2), st.floats(-0.5, 0.5))
alphas = st.tuples(st.floats(0.3, 1.2), st.floats(0.3, 1.2))
states = st.tuples(
    length, length, st.floats(-3.2, 3.2), icrs, st.floats(-0.1, 0.1), alphas | st.just((1.0, 1.0))
).map(lambda s: np.array([*s[:3], *s[3], s[4], *s[5]]))
yaw_rates = st.just(np.nan) | st.floats(-2, 2)
added = st.tuples(*[st.floats(-0.1, 0.1)] * 5).map(
    lambda a: {"added_speeds": np.array(a[:2]), "added_twist": np.array(a[2:])}
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


@given(states, tread_speeds, steps_s, yaw_rates, added)
def test_a_pose_moves_as_the_state_does(state, speeds, step_s, yaw_rate, effects):
    given_too = {"yaw_rate_rad_s": yaw_rate, **effects}
    moved, _ = transition(state, speeds, step_s, **given_too)
    pose = moved_pose(state[:3], state * [0, 0, 0, 1, 1, 1, 1, 1, 1], speeds, step_s, **given_too)
    np.testing.assert_array_equal(pose, moved[:3])


@given(states, tread_speeds, steps_s, yaw_rates, added)
def test_jacobian_is_the_derivative(state, speeds, step_s, yaw_rate, effects):
    """Central differences of 1e-6 around positions of 20 m: rounding below 1e-8."""
    h, given_too = 1e-6, {"yaw_rate_rad_s": yaw_rate, **effects}
    columns = [
        difference(
            transition(state + h * e, speeds, step_s, **given_too)[0],
            transition(state - h * e, speeds, step_s, **given_too)[0],
        )
        / (2 * h)
        for e in np.eye(STATES)
    ]
    jacobian = transition(state, speeds, step_s, **given_too)[1]
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
    state[6:] = 0, 1, 1
    to_world = np.array([[c, -s, 0], [s, c, 0], [0, 0, 1]])
    ours = to_world @ icr_twist_jacobian(state[3:6], speeds)
    np.testing.assert_allclose(ours * [1, 1, -1], by_chens_icrs, rtol=0, atol=1e-11)
    step_s = 1e-6
    in_the_limit = transition(state, speeds, step_s)[1][:3, 3:6] / step_s
    np.testing.assert_allclose(in_the_limit * [1, 1, -1], by_chens_icrs, rtol=1e-4, atol=1e-3)


@given(states, tread_speeds, steps_s, yaw_rates, st.integers(2, 9))
def test_splitting_a_step_changes_nothing(state, speeds, step_s, yaw_rate, parts):
    whole, jacobian = transition(state, speeds, step_s, yaw_rate_rad_s=yaw_rate)
    split, product = state, np.eye(STATES)
    for _ in range(parts):
        split, part = transition(split, speeds, step_s / parts, yaw_rate_rad_s=yaw_rate)
        product = part @ product
    np.testing.assert_allclose(difference(split, whole), 0, atol=1e-11)
    np.testing.assert_allclose(product, jacobian, rtol=0, atol=1e-9)


@given(states, tread_speeds, steps_s)
def test_all_but_the_pose_stays(state, speeds, step_s):
    np.testing.assert_array_equal(transition(state, speeds, step_s)[0][3:], state[3:])


def test_a_step_of_no_time_changes_nothing():
    state = np.array([1, 2, 3, 0.4, -0.3, 0.1, 0.01, 0.9, 1.0])
    after, jacobian = transition(state, np.array([1.0, 2.0]), 0.0)
    np.testing.assert_allclose(after, state, atol=1e-15)
    np.testing.assert_array_equal(jacobian, np.eye(STATES))


@given(states, tread_speeds, steps_s, added)
def test_treads_turn_it_as_the_model_of_their_icrs_does(state, speeds, step_s, effects):
    twist = icr_twist(state[3:6], state[7:] * (speeds + effects["added_speeds"]))
    moved = se2.exp((twist + effects["added_twist"]) * step_s)
    expected = np.append(se2.compose(state[:3], moved), state[3:])
    after = transition(state, speeds, step_s, **effects)[0]
    np.testing.assert_allclose(difference(after, expected), 0, atol=1e-12)


@given(states, tread_speeds, steps_s)
def test_a_gyroscope_that_agrees_with_the_treads_changes_nothing(state, speeds, step_s):
    omega = icr_twist(state[3:6], state[7:] * speeds)[2]
    by_treads = transition(state, speeds, step_s)[0]
    by_gyroscope = transition(state, speeds, step_s, yaw_rate_rad_s=omega + state[6])[0]
    np.testing.assert_allclose(by_gyroscope, by_treads, atol=1e-12)
