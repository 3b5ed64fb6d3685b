import numpy as np
import pytest

from odometry.errors import TrajectoryError
from odometry.trajectory import Trajectory

L_SHAPE = Trajectory(np.array([0.0, 1.0, 3.0]), np.array([[0, 0, 0], [2, 0, 1], [2, 4, -1.0]]))


def test_between_poses_is_linear():
    at = L_SHAPE.at(np.array([0.25, 2.0]))
    np.testing.assert_allclose(at.poses, [[0.5, 0, 0.25], [2, 2, 0]], atol=1e-15)
    assert at.stamps_s.tolist() == [0.25, 2.0]


def test_its_own_stamps_give_its_own_poses():
    np.testing.assert_allclose(L_SHAPE.at(L_SHAPE.stamps_s).poses, L_SHAPE.poses, atol=1e-15)


def test_yaw_goes_the_shorter_way():
    """From +170 to -170 degrees over the half turn, not back over zero."""
    yaws = np.deg2rad([170, -170])
    turning = Trajectory(np.array([0.0, 1.0]), np.column_stack([np.zeros((2, 2)), yaws]))
    yaw = turning.at(np.array([0.25])).poses[0, 2]
    assert abs(np.exp(1j * yaw) - np.exp(1j * np.deg2rad(175))) < 1e-12


@pytest.mark.parametrize("stamp_s", [-0.1, 3.1])
def test_outside_is_an_error(stamp_s):
    with pytest.raises(TrajectoryError, match=str(stamp_s)):
        L_SHAPE.at(np.array([stamp_s]))


def test_covers_includes_both_ends():
    covers = L_SHAPE.covers(np.array([-1, 0, 1.5, 3, 3.1]))
    assert np.asarray(covers, bool).tolist() == [False, True, True, True, False]


def test_moved_places_the_frame():
    """A frame at (10, 0) that looks left: its x is the parent's y."""
    moved = L_SHAPE.moved(np.array([10, 0, np.pi / 2]))
    np.testing.assert_allclose(moved.poses[:, :2], [[10, 0], [10, 2], [6, 2]], atol=1e-14)
    np.testing.assert_allclose(
        np.exp(1j * moved.poses[:, 2]), np.exp(1j * (L_SHAPE.poses[:, 2] + np.pi / 2))
    )
    assert L_SHAPE.poses[0].tolist() == [0, 0, 0]


@pytest.mark.parametrize(
    ("stamps_s", "poses"),
    [
        (np.array([0.0, 0.0]), np.zeros((2, 3))),
        (np.array([1.0, 0.0]), np.zeros((2, 3))),
        (np.array([0.0, 1.0]), np.zeros((3, 3))),
        (np.array([0.0, 1.0]), np.zeros((2, 2))),
    ],
)
def test_malformed_is_an_error(stamps_s, poses):
    with pytest.raises(TrajectoryError):
        Trajectory(stamps_s, poses)


def test_length():
    assert len(L_SHAPE) == 3
