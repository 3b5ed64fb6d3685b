"""What sensors measure against the state: finite differences, and motions done by hand."""

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from odometry.estimation.measurement import (
    Measurement,
    pose_measurement,
    reference_point,
    tread_yaw_rate,
    velocity_measurement,
    weighed_down,
)
from odometry.estimation.transition import STATES, transition

LEVER = (0.4, -0.2)
R = np.diag([0.1, 0.2, 0.3])
coordinate, angle = st.floats(-20, 20), st.floats(-3.1, 3.1)
states = st.tuples(
    coordinate,
    coordinate,
    angle,
    st.floats(0.2, 1),
    st.floats(-1, -0.2),
    st.floats(-0.5, 0.5),
    st.floats(-0.1, 0.1),
    st.floats(0.3, 1.2),
    st.floats(0.3, 1.2),
).map(np.array)
speeds = st.tuples(st.floats(-2, 2), st.floats(-2, 2)).map(np.array)


def assert_derivative(residual_at, state, jacobian):
    """Residuals are measured less expected: their derivative is that of the expected, negated."""
    h = 1e-6
    columns = [(residual_at(state - h * e) - residual_at(state + h * e)) / (2 * h) for e in STEPS]
    np.testing.assert_allclose(jacobian, np.stack(columns, axis=-1), rtol=1e-5, atol=1e-6)


STEPS = np.eye(STATES)


@given(states, st.tuples(coordinate, coordinate).map(np.array))
def test_the_derivative_of_a_pose_with_a_lever_arm(state, place):
    pose = np.append(place, state[2] + 0.1)
    measured = pose_measurement(state, pose, R, LEVER)
    assert_derivative(
        lambda s: pose_measurement(s, pose, R, LEVER).residual, state, measured.jacobian
    )


@given(states, speeds, st.floats(-2, 2))
def test_the_derivative_of_the_yaw_rate_of_treads(state, treads, rate):
    measured = tread_yaw_rate(state, treads, rate)
    assert_derivative(lambda s: tread_yaw_rate(s, treads, rate).residual, state, measured.by_state)


@given(states, speeds, st.just(np.nan) | st.floats(-2, 2))
def test_the_derivative_of_a_velocity(state, treads, rate):
    def residual_at(s):
        return velocity_measurement(s, np.zeros(3), treads, rate, R).residual

    measured = velocity_measurement(state, np.zeros(3), treads, rate, R)
    assert_derivative(residual_at, state, measured.jacobian)


@given(states, speeds, st.just(np.nan) | st.floats(-2, 2))
def test_what_is_expected_of_a_velocity_is_the_motion_of_a_short_step(state, treads, rate):
    step_s = 1e-7
    moved = transition(state, treads, step_s, yaw_rate_rad_s=rate)[0] - state
    cosine, sine = np.cos(state[2]), np.sin(state[2])
    body = np.array([cosine * moved[0] + sine * moved[1], cosine * moved[1] - sine * moved[0]])
    twist = np.append(body, moved[2]) / step_s
    residual = velocity_measurement(state, twist, treads, rate, R).residual
    np.testing.assert_allclose(residual, 0, atol=1e-5)


def test_the_place_of_an_antenna():
    """It sits 0.4 m ahead and 0.2 m to the right; the robot looks along y."""
    state = np.array([1.0, 2.0, np.pi / 2, 0.3, -0.3, 0, 0, 1, 1])
    np.testing.assert_allclose(reference_point(state, LEVER), [1.2, 2.4])
    measured = pose_measurement(state, np.array([1.2, 2.4, np.pi / 2]), R, LEVER)
    np.testing.assert_allclose(measured.residual, 0, atol=1e-15)


@pytest.mark.parametrize(
    ("pose", "places"),
    [
        ((1, 2, np.nan), [0, 1]),
        ((np.nan, np.nan, 0.5), [2]),
        ((np.nan, 2, 0.5), [1, 2]),
        ((np.nan, np.nan, np.nan), []),
    ],
)
def test_only_what_was_measured_counts(pose, places):
    state = np.array([1.5, 2.5, 0.1, 0.3, -0.3, 0, 0, 1, 1])
    whole = pose_measurement(state, np.array([1, 2, 0.5]), R, LEVER)
    part = pose_measurement(state, np.array(pose, dtype=float), R, LEVER)
    np.testing.assert_array_equal(part.residual, whole.residual[places])
    np.testing.assert_array_equal(part.jacobian, whole.jacobian[places])
    np.testing.assert_array_equal(part.covariance, R[np.ix_(places, places)])


@given(
    residual=st.lists(st.floats(-30, 30), min_size=3, max_size=3),
    spread=st.floats(0.0, 2.0),
    state=states,
)
def test_what_lies_far_off_weighs_as_huber_has_it(residual, spread, state):
    """Noise grows by the square of the deviations over two of them, of each number by itself."""
    covariance = spread**2 * np.eye(STATES)
    jacobian = velocity_measurement(state, np.zeros(3), np.array([0.4, 0.9]), 0.2, R).jacobian
    measured = Measurement(np.array(residual), jacobian, R)
    noise = np.diag(weighed_down(measured, covariance).covariance)
    expected = np.diag(jacobian @ covariance @ jacobian.T + R)
    deviations = np.abs(residual) / np.sqrt(expected)
    factors = np.where(deviations > 2, deviations**2 / 4, 1.0)
    np.testing.assert_allclose(noise, np.diag(R) * factors, rtol=1e-9)
