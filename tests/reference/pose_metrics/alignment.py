"""Bring a trajectory to the stamps and into the frame of a reference."""

import numpy as np

from odometry.errors import TrajectoryError
from odometry.geometry import se3
from odometry.trajectory import SpatialTrajectory

LINE = 1e-12  # second over first singular value below which positions lie on one line


def at_common_stamps(
    trajectory: SpatialTrajectory, reference: SpatialTrajectory
) -> tuple[SpatialTrajectory, SpatialTrajectory]:
    """Both at the reference's stamps that the trajectory covers, the trajectory interpolated.

    Raises
    ------
    TrajectoryError
        If they have no time in common.
    """
    both = trajectory.covers(reference.stamps_s)
    if not both.any():
        raise TrajectoryError(
            f"the trajectory covers {trajectory.stamps_s[0]:.3f} to {trajectory.stamps_s[-1]:.3f} "
            f"s, the reference {reference.stamps_s[0]:.3f} to {reference.stamps_s[-1]:.3f} s; "
            "expected a stamp of the reference within the trajectory"
        )
    stamps_s = reference.stamps_s[both]
    return trajectory.at(stamps_s), SpatialTrajectory(stamps_s, reference.poses[both])


def align_origin(trajectory: SpatialTrajectory, reference: SpatialTrajectory) -> SpatialTrajectory:
    """The trajectory moved so that its pose at their first common stamp is the reference's."""
    ours, true = at_common_stamps(trajectory, reference)
    return trajectory.moved(true.poses[0] @ se3.inverse(ours.poses[0]))


def align_rigid(trajectory: SpatialTrajectory, reference: SpatialTrajectory) -> SpatialTrajectory:
    """The trajectory moved so that the squared position errors at common stamps are least.

    Rotation and translation of Umeyama 1991 (IEEE PAMI 13(4), eq. 38 to 43, without scale).

    Raises
    ------
    TrajectoryError
        If all positions lie on one line, around which the rotation would be free.
    """
    ours, true = (both.positions_m for both in at_common_stamps(trajectory, reference))
    our_mean, true_mean = ours.mean(axis=0), true.mean(axis=0)
    covariance = (true - true_mean).T @ (ours - our_mean) / len(ours)  # eq. 38
    u, sizes, v_transposed = np.linalg.svd(covariance)
    if sizes[1] <= LINE * sizes[0]:
        raise TrajectoryError(
            f"{len(ours)} common positions on one line; a rigid alignment needs a path that bends"
        )
    handedness = np.linalg.det(u) * np.linalg.det(v_transposed)  # eq. 43
    rotation = u @ np.diag([1.0, 1.0, np.sign(handedness)]) @ v_transposed  # eq. 40
    return trajectory.moved(se3.pose(true_mean - rotation @ our_mean, rotation))  # eq. 41
