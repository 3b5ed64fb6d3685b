import numpy as np
import pytest
from scipy.spatial.transform import Rotation

from odometry.errors import TrajectoryError
from odometry.evaluation.relative import position_errors
from odometry.geometry import se3
from odometry.trajectory import SpatialTrajectory, Trajectory
from tests.reference.pose_metrics.pose_errors import (
    absolute_pose_errors,
    relative_pose_errors,
    statistics,
)


def in_plane(poses):
    plane = Trajectory(np.arange(float(len(poses))), np.array(poses, dtype=float))
    return SpatialTrajectory.from_plane(plane)


REFERENCE = in_plane([[0, 0, 0], [1, 0, 0], [2, 0, np.pi / 2]])
AWAY = in_plane([[0, 0, 0], [1, 0, 0.3], [2, 2, 0]])


def test_absolute_errors_by_hand():
    """Off by nothing, by 0.3 rad, and by two metres and a quarter turn.

    A turn by a alone has the Frobenius norm 2 sqrt(2) sin(a / 2); a translation adds its square.
    """
    errors = absolute_pose_errors(AWAY, REFERENCE)
    np.testing.assert_allclose(errors.translation_m, [0, 0, 2], rtol=0, atol=1e-15)
    np.testing.assert_allclose(errors.rotation_rad, [0, 0.3, np.pi / 2], rtol=0, atol=1e-15)
    full = [0, 2 * np.sqrt(2) * np.sin(0.15), np.sqrt(4 + 4)]
    np.testing.assert_allclose(errors.full, full, rtol=0, atol=1e-15)


def test_relative_errors_by_hand():
    """From the second pose, one metre ahead with a left turn; AWAY sees (cos 0.3 ...) ahead."""
    errors = relative_pose_errors(AWAY, REFERENCE, np.array([[0, 1], [1, 2]]))
    seen = np.array([np.cos(0.3) + 2 * np.sin(0.3), 2 * np.cos(0.3) - np.sin(0.3)])
    miss = np.linalg.norm(seen - [1, 0])
    np.testing.assert_allclose(errors.translation_m, [0, miss], rtol=0, atol=1e-15)
    np.testing.assert_allclose(errors.rotation_rad, [0.3, 0.3 + np.pi / 2], rtol=0, atol=1e-15)


def test_position_errors_of_the_plane_are_the_same():
    _, distances = position_errors(AWAY.plane, REFERENCE.plane)
    ours = absolute_pose_errors(AWAY, REFERENCE).translation_m
    np.testing.assert_allclose(ours, distances, rtol=0, atol=1e-15)


def test_relative_errors_do_not_see_where_the_frame_is():
    frame = se3.pose(np.array([5.0, 6, 7]), Rotation.from_rotvec([1.0, 2, 3]).as_matrix())
    pairs = np.array([[0, 1], [0, 2], [1, 2]])
    here = relative_pose_errors(AWAY, REFERENCE, pairs)
    there = relative_pose_errors(AWAY.moved(frame), REFERENCE, pairs)
    for name in ("translation_m", "rotation_rad", "full"):
        np.testing.assert_allclose(getattr(here, name), getattr(there, name), rtol=0, atol=1e-13)


def test_no_pairs_give_no_errors():
    errors = relative_pose_errors(AWAY, REFERENCE, np.empty((0, 2), dtype=int))
    assert errors.translation_m.shape == errors.rotation_rad.shape == errors.full.shape == (0,)


def test_statistics_by_hand():
    """Of 3, 4, 8, 1: squares 9, 16, 64, 1; deviations from the mean -1, 0, 4, -3."""
    summary = statistics(np.array([3.0, 4, 8, 1]))
    assert (summary.sse, summary.rmse) == (90, np.sqrt(22.5))
    assert (summary.mean, summary.median, summary.min, summary.max) == (4, 3.5, 1, 8)
    assert summary.std == np.sqrt(26 / 4)


def test_statistics_of_nothing_are_an_error():
    with pytest.raises(TrajectoryError, match="no errors"):
        statistics(np.empty(0))


def test_other_stamps_are_an_error():
    shifted = SpatialTrajectory(AWAY.stamps_s + 1e-6, AWAY.poses)
    with pytest.raises(TrajectoryError, match="at_common_stamps"):
        absolute_pose_errors(shifted, REFERENCE)
    with pytest.raises(TrajectoryError, match="at_common_stamps"):
        relative_pose_errors(shifted, REFERENCE, np.array([[0, 1]]))
