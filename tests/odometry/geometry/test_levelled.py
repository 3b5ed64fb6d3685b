import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from scipy.spatial.transform import Rotation

from odometry.geometry.tilt import level_step_jacobian, level_steps, rises, tilt_of

angle = st.floats(-0.6, 0.6)
step = st.tuples(st.floats(-2, 2), st.floats(-2, 2), st.floats(-3, 3)).map(np.array)


@given(step, angle, angle, st.floats(-3, 3))
def test_against_rotation_matrices(step, roll, pitch, yaw):
    """Carry the step and the turned x axis into the world, take the yaw off again."""
    world_from_body = Rotation.from_euler("ZYX", [yaw, pitch, roll])
    level_from_body = Rotation.from_euler("z", -yaw) * world_from_body
    moved = level_from_body.apply([step[0], step[1], 0])
    heading = level_from_body.apply([np.cos(step[2]), np.sin(step[2]), 0])
    along, across, change = level_steps(step, tilt_of(np.array(roll), np.array(pitch)))
    np.testing.assert_allclose([along, across], moved[:2], rtol=0, atol=1e-14)
    assert rises(step, tilt_of(np.array(roll), np.array(pitch))) == pytest.approx(
        moved[2], abs=1e-14
    )
    difference = change - np.arctan2(heading[1], heading[0])
    assert np.cos(difference) == pytest.approx(1, abs=1e-14)
    assert np.sin(difference) == pytest.approx(0, abs=1e-14)


def test_the_nose_down_goes_down_and_the_right_side_down_lifts_the_left():
    forward, left = np.array([1.0, 0, 0]), np.array([0, 1.0, 0])
    assert rises(forward, tilt_of(np.array(0.0), np.array(0.1))) == pytest.approx(-np.sin(0.1))
    assert rises(left, tilt_of(np.array(0.1), np.array(0.0))) == pytest.approx(np.sin(0.1))


@given(st.lists(st.tuples(st.floats(-5, 5), st.floats(-5, 5), st.floats(-20, 20)), min_size=1))
def test_level_ground_changes_nothing(steps):
    """Steps of several turns, too."""
    steps, level = np.array(steps), tilt_of(np.array(0.0), np.array(0.0))
    np.testing.assert_allclose(level_steps(steps, level), steps, rtol=0, atol=1e-14)
    np.testing.assert_array_equal(rises(steps, level), 0)


@given(angle, angle)
def test_whole_and_half_turns_of_the_body_are_those_of_its_yaw(roll, pitch):
    steps = np.column_stack([np.zeros((7, 2)), np.pi * np.arange(-3, 4)])
    changes = level_steps(steps, tilt_of(np.array(roll), np.array(pitch)))[:, 2]
    np.testing.assert_allclose(changes, steps[:, 2], rtol=0, atol=1e-12)


@given(step, angle, angle)
def test_jacobian_is_the_derivative(step, roll, pitch):
    h, tilt = 1e-5, tilt_of(np.array(roll), np.array(pitch))
    numeric = [
        (level_steps(step + h * e, tilt) - level_steps(step - h * e, tilt)) / (2 * h)
        for e in np.eye(3)
    ]
    jacobian = level_step_jacobian(step, tilt)
    np.testing.assert_allclose(jacobian, np.transpose(numeric), rtol=0, atol=1e-9)


@pytest.mark.parametrize("function", [level_steps, rises, level_step_jacobian])
def test_steps_and_attitudes_broadcast(function, rng):
    steps, rolls, pitches = rng.normal(size=(4, 1, 3)), rng.normal(size=5) / 9, np.array(0.1)
    answers = function(steps, tilt_of(rolls, pitches))
    assert answers.shape[:2] == (4, 5)
    np.testing.assert_allclose(
        answers[2, 3], function(steps[2, 0], tilt_of(rolls[3], pitches)), rtol=0, atol=1e-15
    )
