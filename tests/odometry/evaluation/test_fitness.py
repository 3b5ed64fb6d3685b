import numpy as np
import pytest

from odometry.errors import TrajectoryError
from odometry.evaluation.open_loop import fitness
from odometry.geometry import se3
from odometry.trajectory import SpatialTrajectory

STAMPS_S = np.arange(4.0)
REFERENCE = np.array([[0, 0, 0, 3.0], [1, 0, 0.5, 3.1], [2, 0, 1, -3.1], [9, 9, 9, 9]])


def trajectory(x, y, z, yaw):
    rotations = se3.rotation_from_roll_pitch_yaw(
        np.column_stack([np.full(len(x), 0.2), np.full(len(x), -0.1), yaw])
    )
    poses = se3.pose(np.column_stack([x, y, z]), rotations)
    return SpatialTrajectory(STAMPS_S[: len(x)], poses)


OURS = trajectory([0, 1.3, 2], [0, 0, -0.6], [0, 0.5, 1.9], [3, 3.1, 3.1])


def test_sums_of_squares_over_the_covered_poses():
    """Errors: nothing; 0.3 in x; -0.6 in y, 0.9 in z and the short way round in yaw."""
    result = fitness(OURS, STAMPS_S, REFERENCE)
    yaw = 2 * np.pi - 6.2
    assert (result.poses, result.heights) == (3, 3)
    parts = [result.x_m2, result.y_m2, result.z_m2, result.yaw_rad2]
    np.testing.assert_allclose(parts, np.array([0.09, 0.36, 0.81, yaw**2]) / 3, atol=1e-14)
    assert result.mean == pytest.approx((1.26 + yaw**2) / 3, rel=1e-13)
    assert result.total == pytest.approx(1.26 + yaw**2, rel=1e-13)


def test_turns_count_in_full():
    """The reference turns by 2 rad a second and the odometer by 4: 0, 2, 4 and 6 rad off."""
    still = np.zeros(4)
    reference = np.column_stack([still, still, still, [0, 2, 4 - 2 * np.pi, 6 - 2 * np.pi]])
    ours = trajectory(still, still, still, [0, 4, 8 - 2 * np.pi, 12 - 4 * np.pi])
    assert fitness(ours, STAMPS_S, reference).yaw_rad2 == pytest.approx((4 + 16 + 36) / 4)


def test_heights_count_only_where_they_were_measured():
    partly = REFERENCE.copy()
    partly[2, 2] = np.nan
    result = fitness(OURS, STAMPS_S, partly)
    assert (result.poses, result.heights, result.z_m2) == (3, 2, 0)
    assert result.y_m2 == pytest.approx(0.12)


def test_a_trajectory_equal_to_the_reference_has_none():
    perfect = trajectory(*REFERENCE[:3].T)
    assert fitness(perfect, STAMPS_S, REFERENCE).total == pytest.approx(0, abs=1e-28)


def test_nothing_covered_is_an_error():
    with pytest.raises(TrajectoryError, match="none of the 4"):
        fitness(OURS, STAMPS_S + 10, REFERENCE)
