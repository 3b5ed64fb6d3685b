"""Absolute and relative pose errors, as the field's evaluators define them (APE and RPE).

Bring both to common stamps (`alignment.at_common_stamps`), align where that is wanted
(`alignment.align_origin`, `alignment.align_rigid`), then take the errors. A trajectory of the
plane comes in through `SpatialTrajectory.from_plane`.
"""

from dataclasses import dataclass

import numpy as np
from scipy.spatial.transform import Rotation

from odometry.arrays import FloatArray, IntArray
from odometry.errors import TrajectoryError
from odometry.geometry import se3
from odometry.trajectory import SpatialTrajectory


@dataclass(frozen=True)
class PoseErrors:
    """What is left of K poses or motions E where a perfect one leaves the identity.

    Attributes
    ----------
    translation_m : (K,)
        Length of the translation of E.
    rotation_rad : (K,)
        Angle of its rotation, 0 to pi.
    full : (K,)
        Frobenius norm of E - I, which mixes metres and radians.
    """

    translation_m: FloatArray
    rotation_rad: FloatArray
    full: FloatArray


@dataclass(frozen=True)
class Statistics:
    """Summary of errors: root mean square, mean, median, deviation, extremes, sum of squares."""

    rmse: float
    mean: float
    median: float
    std: float
    min: float
    max: float
    sse: float


def absolute_pose_errors(trajectory: SpatialTrajectory, reference: SpatialTrajectory) -> PoseErrors:
    """Errors of each pose in the reference's frame (Sturm 2012, IROS, eq. 4 with S = I).

    Parameters
    ----------
    trajectory, reference : SpatialTrajectory
        With equal stamps.

    Raises
    ------
    TrajectoryError
        If their stamps differ.
    """
    _check_stamps(trajectory, reference)
    return _errors(se3.between(reference.poses, trajectory.poses))


def relative_pose_errors(
    trajectory: SpatialTrajectory, reference: SpatialTrajectory, pairs: IntArray
) -> PoseErrors:
    """Errors of the motion between pairs of poses (Sturm 2012, IROS, eq. 1).

    Parameters
    ----------
    trajectory, reference : SpatialTrajectory
        With equal stamps.
    pairs : (K, 2)
        First and last sample of each motion, see `pose_pairs`.

    Raises
    ------
    TrajectoryError
        If their stamps differ.
    """
    _check_stamps(trajectory, reference)
    first, last = np.asarray(pairs).T
    motion, true_motion = (
        se3.between(each.poses[first], each.poses[last]) for each in (trajectory, reference)
    )
    return _errors(se3.between(true_motion, motion))


def statistics(errors: FloatArray) -> Statistics:
    """Summary of errors (K,).

    Raises
    ------
    TrajectoryError
        If there is none.
    """
    if not len(errors):
        raise TrajectoryError("no errors to summarise: the trajectories are shorter than a pair")
    squares = np.square(errors)
    return Statistics(
        rmse=float(np.sqrt(squares.mean())),
        mean=float(np.mean(errors)),
        median=float(np.median(errors)),
        std=float(np.std(errors)),
        min=float(np.min(errors)),
        max=float(np.max(errors)),
        sse=float(squares.sum()),
    )


def _errors(left_over: FloatArray) -> PoseErrors:
    turns = left_over[:, :3, :3]
    return PoseErrors(
        np.linalg.norm(left_over[:, :3, 3], axis=-1),
        # SciPy 1.14 makes no rotations of nothing
        Rotation.from_matrix(turns).magnitude() if len(turns) else np.empty(0),
        np.linalg.norm(left_over - np.eye(4), axis=(-2, -1)),
    )


def _check_stamps(trajectory: SpatialTrajectory, reference: SpatialTrajectory) -> None:
    if not np.array_equal(trajectory.stamps_s, reference.stamps_s):
        raise TrajectoryError(
            f"{len(trajectory)} poses against {len(reference)} of the reference, at other stamps; "
            "expected equal stamps (at_common_stamps)"
        )
