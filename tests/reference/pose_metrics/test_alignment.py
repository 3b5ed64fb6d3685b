import numpy as np
import pytest
from scipy.spatial.transform import Rotation

from odometry.errors import TrajectoryError
from odometry.geometry import se3
from odometry.trajectory import SpatialTrajectory
from tests.reference.pose_metrics.alignment import align_origin, align_rigid, at_common_stamps

FRAME = se3.pose(np.array([5.0, -3, 2]), Rotation.from_rotvec([0.4, -1.2, 2.0]).as_matrix())


def winding(rng, count=30):
    """A random walk in space."""
    positions = np.cumsum(rng.normal(size=(count, 3)), axis=0)
    rotations = Rotation.from_rotvec(rng.normal(size=(count, 3))).as_matrix()
    return SpatialTrajectory(0.5 * np.arange(count), se3.pose(positions, rotations))


@pytest.mark.parametrize("align", [align_origin, align_rigid])
def test_a_moved_copy_comes_back(align, rng):
    """The whole of it, also where the reference covers only a part."""
    whole = winding(rng)
    part = SpatialTrajectory(whole.stamps_s[7:20], whole.poses[7:20])
    aligned = align(whole.moved(FRAME), part)
    np.testing.assert_allclose(aligned.poses, whole.poses, rtol=0, atol=1e-12)


def test_align_origin_fits_the_first_common_pose(rng):
    reference, other = winding(rng), winding(rng)
    late = SpatialTrajectory(other.stamps_s[3:], other.poses[3:])
    aligned = align_origin(late, reference)
    np.testing.assert_allclose(aligned.poses[0], reference.poses[3], rtol=0, atol=1e-13)
    inside = se3.between(aligned.poses[0], aligned.poses)
    np.testing.assert_allclose(inside, se3.between(late.poses[0], late.poses), rtol=0, atol=1e-12)


def test_align_rigid_is_scipys_least_squares(rng):
    reference, other = winding(rng), winding(rng)
    rotation, _ = Rotation.align_vectors(
        reference.positions_m - reference.positions_m.mean(axis=0),
        other.positions_m - other.positions_m.mean(axis=0),
    )
    aligned = align_rigid(other, reference)
    turned = rotation.as_matrix() @ other.poses[:, :3, :3]
    np.testing.assert_allclose(aligned.poses[:, :3, :3], turned, rtol=0, atol=1e-12)
    means = aligned.positions_m.mean(axis=0), reference.positions_m.mean(axis=0)
    np.testing.assert_allclose(*means, rtol=0, atol=1e-12)


def test_a_mirror_image_is_turned_never_mirrored(rng):
    reference = winding(rng)
    mirrored = reference.poses.copy()
    mirrored[:, 0, 3] *= -1
    aligned = align_rigid(SpatialTrajectory(reference.stamps_s, mirrored), reference)
    np.testing.assert_allclose(np.linalg.det(aligned.poses), 1, rtol=0, atol=1e-12)
    assert np.abs(aligned.positions_m - reference.positions_m).max() > 0.1


@pytest.mark.parametrize("direction", [np.zeros(3), np.array([1.0, 2, -0.5])])
def test_a_straight_line_cannot_be_aligned(direction):
    poses = se3.pose(np.arange(9)[:, None] * direction, np.eye(3))
    line = SpatialTrajectory(np.arange(9.0), poses)
    with pytest.raises(TrajectoryError, match="9 common positions on one line"):
        align_rigid(line, line)


def test_common_stamps_are_those_of_the_reference_that_the_trajectory_covers(rng):
    trajectory, reference = winding(rng, 10), winding(rng, 30)
    shifted = SpatialTrajectory(reference.stamps_s - 2.1, reference.poses)
    ours, true = at_common_stamps(trajectory, shifted)
    np.testing.assert_allclose(ours.stamps_s, 0.4 + 0.5 * np.arange(9), rtol=0, atol=1e-12)
    np.testing.assert_array_equal(true.stamps_s, ours.stamps_s)
    np.testing.assert_array_equal(true.poses, reference.poses[5:14])
    np.testing.assert_array_equal(ours.poses, trajectory.at(ours.stamps_s).poses)


def test_nothing_in_common_is_an_error(rng):
    early = winding(rng, 3)
    late = SpatialTrajectory(early.stamps_s + 100, early.poses)
    with pytest.raises(TrajectoryError, match=r"0\.000 to 1\.000 s, the reference 100\.000"):
        at_common_stamps(early, late)
