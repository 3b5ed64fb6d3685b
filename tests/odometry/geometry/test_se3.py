"""Against scipy's rotations, an independent program; conventions by asymmetric examples."""

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from scipy.spatial.transform import Rotation

from odometry.geometry import se3

angle = st.floats(-3.1, 3.1)
pitch = st.floats(-1.57, 1.57)
vector = st.tuples(*[st.floats(-3, 3)] * 3).map(np.array)


@given(angle, pitch, angle)
def test_roll_pitch_yaw_is_rep_103s_order(roll, pitch, yaw):
    """scipy's intrinsic ZYX: Rz(yaw) Ry(pitch) Rx(roll)."""
    rotation = se3.rotation_from_roll_pitch_yaw(np.array([roll, pitch, yaw]))
    theirs = Rotation.from_euler("ZYX", [yaw, pitch, roll])
    np.testing.assert_allclose(rotation, theirs.as_matrix(), rtol=0, atol=1e-15)
    np.testing.assert_allclose(se3.roll_pitch_yaw(rotation), [roll, pitch, yaw], atol=1e-9)


def test_the_signs_of_the_angles():
    """Pitch > 0 has the nose down, roll > 0 the right side down, yaw > 0 turns left."""
    forward, left, _ = np.eye(3)
    nose_down, right_down, turned = (
        se3.rotation_from_roll_pitch_yaw(angles) for angles in 0.1 * np.eye(3)[[1, 0, 2]]
    )
    assert (nose_down @ forward)[2] == pytest.approx(-np.sin(0.1))
    assert (right_down @ left)[2] == pytest.approx(np.sin(0.1))
    assert (turned @ forward)[1] == pytest.approx(np.sin(0.1))


@given(angle, st.sampled_from([-np.pi / 2, np.pi / 2]), angle)
def test_with_the_nose_straight_up_the_angles_still_give_the_matrix_back(roll, pitch, yaw):
    rotation = se3.rotation_from_roll_pitch_yaw(np.array([roll, pitch, yaw]))
    again = se3.rotation_from_roll_pitch_yaw(se3.roll_pitch_yaw(rotation))
    np.testing.assert_allclose(again, rotation, rtol=0, atol=1e-12)


def test_a_roll_with_the_nose_straight_down_is_kept():
    """Ry(90 degrees) Rx(90 degrees) in whole numbers: every term of the usual roll is zero."""
    rotation = np.array([[0.0, 1, 0], [0, 0, -1], [-1, 0, 0]])
    np.testing.assert_array_equal(se3.roll_pitch_yaw(rotation), [np.pi / 2, np.pi / 2, 0])


@given(vector)
def test_quaternions_are_scipys_with_w_first_and_not_negative(turn):
    theirs = Rotation.from_rotvec(turn)
    quaternion = se3.quaternion_wxyz(theirs.as_matrix())
    assert quaternion[0] >= 0
    x, y, z, w = theirs.as_quat(canonical=True)
    np.testing.assert_allclose(np.abs(quaternion @ [w, x, y, z]), 1, rtol=0, atol=1e-14)
    np.testing.assert_allclose(
        se3.rotation_from_quaternion_wxyz(quaternion), theirs.as_matrix(), rtol=0, atol=1e-14
    )


@pytest.mark.parametrize("axis", np.vstack([np.eye(3), np.eye(3)[[1, 2, 0]] + np.eye(3)]))
@pytest.mark.parametrize("angle", [0.0, 1e-9, np.pi - 1e-9, np.pi])
def test_small_and_half_turns_keep_their_matrix(axis, angle):
    axis = axis / np.linalg.norm(axis)
    rotation = Rotation.from_rotvec(angle * axis).as_matrix()
    quaternion = se3.quaternion_wxyz(rotation)
    again = se3.rotation_from_quaternion_wxyz(quaternion)
    np.testing.assert_allclose(again, rotation, rtol=0, atol=1e-15)


def test_a_quaternion_of_any_length_is_a_direction():
    left_turn = np.array([3.0, 0, 0, 3.0])
    expected = [[0, -1, 0], [1, 0, 0], [0, 0, 1]]
    np.testing.assert_allclose(
        se3.rotation_from_quaternion_wxyz(left_turn), expected, rtol=0, atol=1e-15
    )


def random_poses(rng, *shape):
    rotations = Rotation.from_rotvec(rng.normal(size=(int(np.prod(shape)), 3))).as_matrix()
    return se3.pose(rng.normal(size=(*shape, 3)), rotations.reshape(*shape, 3, 3))


def test_inverse_is_numpys_and_between_undoes_a_composition(rng):
    first, second = random_poses(rng, 7), random_poses(rng, 7)
    np.testing.assert_allclose(se3.inverse(first), np.linalg.inv(first), rtol=0, atol=1e-14)
    np.testing.assert_allclose(se3.between(first, first @ second), second, rtol=0, atol=1e-14)


def test_stacks_are_taken_one_by_one(rng):
    poses = random_poses(rng, 2, 5)
    rotations = poses[..., :3, :3]
    for function in (se3.roll_pitch_yaw, se3.quaternion_wxyz):
        assert function(rotations).shape[:2] == (2, 5)
        np.testing.assert_array_equal(function(rotations)[1, 3], function(rotations[1, 3]))
    np.testing.assert_array_equal(se3.inverse(poses)[1, 3], se3.inverse(poses[1, 3]))
    quaternions = se3.quaternion_wxyz(rotations)
    for function, values in (
        (se3.rotation_from_quaternion_wxyz, quaternions),
        (se3.rotation_from_roll_pitch_yaw, se3.roll_pitch_yaw(rotations)),
    ):
        np.testing.assert_allclose(function(values), rotations, rtol=0, atol=1e-14)
