import numpy as np
import pytest
from scipy.spatial.transform import Rotation, Slerp

from odometry.errors import TrajectoryError
from odometry.geometry import se3
from odometry.trajectory import SpatialTrajectory, Trajectory


def make(stamps_s, positions, angles):
    """From roll, pitch, yaw by scipy."""
    rotations = Rotation.from_euler("ZYX", np.flip(np.asarray(angles), axis=-1)).as_matrix()
    return SpatialTrajectory(np.asarray(stamps_s, float), se3.pose(np.array(positions), rotations))


CLIMBING = make(
    [0, 1, 3],
    [[0, 0, 0], [2, 0, 0.4], [2, 4, 1]],
    [[0.1, -0.2, 0], [0.2, 0.1, 3.0], [0.0, 0.0, -3.0]],
)


def test_columns_of_it():
    np.testing.assert_allclose(CLIMBING.roll_pitch_yaw[1], [0.2, 0.1, 3.0], rtol=0, atol=1e-15)
    np.testing.assert_array_equal(CLIMBING.positions_m[:, 2], [0, 0.4, 1])
    x, y, z, w = Rotation.from_euler("ZYX", [3.0, 0.1, 0.2]).as_quat(canonical=True)
    np.testing.assert_allclose(CLIMBING.quaternions_wxyz[1], [w, x, y, z], rtol=0, atol=1e-15)
    assert len(CLIMBING) == 3


def test_its_plane_is_x_y_and_yaw():
    plane = CLIMBING.plane
    assert plane.stamps_s.tolist() == [0, 1, 3]
    np.testing.assert_allclose(plane.poses, [[0, 0, 0], [2, 0, 3], [2, 4, -3]], rtol=0, atol=1e-15)


def test_from_the_plane_and_back(rng):
    plane = Trajectory(np.arange(5.0), rng.uniform(-3, 3, size=(5, 3)))
    spatial = SpatialTrajectory.from_plane(plane)
    np.testing.assert_array_equal(spatial.roll_pitch_yaw[:, :2], 0)
    np.testing.assert_array_equal(spatial.positions_m[:, 2], 0)
    np.testing.assert_allclose(spatial.plane.poses, plane.poses, rtol=0, atol=1e-15)


def test_between_poses_positions_are_linear_and_attitudes_on_the_shortest_turn():
    """From yaw 3 to -3 over the half turn; scipy's Slerp is the oracle."""
    stamps_s = np.array([0.25, 2.0, 2.9])
    at = CLIMBING.at(stamps_s)
    np.testing.assert_allclose(at.positions_m[:2], [[0.5, 0, 0.1], [2, 2, 0.7]], atol=1e-15)
    theirs = Slerp(CLIMBING.stamps_s, Rotation.from_matrix(CLIMBING.poses[:, :3, :3]))(stamps_s)
    np.testing.assert_allclose(at.poses[:, :3, :3], theirs.as_matrix(), rtol=0, atol=1e-14)
    assert abs(at.roll_pitch_yaw[1, 2]) > 3


def test_its_own_stamps_give_its_own_poses():
    again = CLIMBING.at(CLIMBING.stamps_s)
    np.testing.assert_allclose(again.poses, CLIMBING.poses, rtol=0, atol=1e-15)
    one = SpatialTrajectory(np.array([4.0]), np.eye(4)[None])
    np.testing.assert_array_equal(one.at(np.array([4.0])).poses, one.poses)


@pytest.mark.parametrize("stamp_s", [-0.1, 3.1])
def test_outside_is_an_error(stamp_s):
    assert not CLIMBING.covers(np.array([stamp_s])).any()
    with pytest.raises(TrajectoryError, match=str(stamp_s)):
        CLIMBING.at(np.array([stamp_s]))


def test_moved_places_the_frame():
    """A frame at height 5 that looks left: its x is the parent's y."""
    frame = se3.pose(np.array([10.0, 0, 5]), Rotation.from_euler("z", np.pi / 2).as_matrix())
    moved = CLIMBING.moved(frame)
    np.testing.assert_allclose(moved.positions_m, [[10, 0, 5], [10, 2, 5.4], [6, 2, 6]], atol=1e-14)
    turned = np.array([0.1, -0.2, np.pi / 2])
    np.testing.assert_allclose(moved.roll_pitch_yaw[0], turned, rtol=0, atol=1e-15)
    assert CLIMBING.poses[0, 0, 3] == 0


@pytest.mark.parametrize(
    ("stamps_s", "poses"),
    [
        (np.zeros(2), np.tile(np.eye(4), (2, 1, 1))),
        (np.arange(2.0), np.tile(np.eye(4), (3, 1, 1))),
        (np.arange(2.0), np.tile(np.eye(3), (2, 1, 1))),
    ],
)
def test_malformed_is_an_error(stamps_s, poses):
    with pytest.raises(TrajectoryError):
        SpatialTrajectory(stamps_s, poses)
