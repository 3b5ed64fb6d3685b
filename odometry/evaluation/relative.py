"""Errors of a trajectory against a reference, per metre of wheel travel and in position."""

from dataclasses import dataclass

import numpy as np

from odometry.arrays import FloatArray
from odometry.config import require_positive
from odometry.evaluation.horizons import spatial_horizons
from odometry.geometry import se2
from odometry.geometry.angles import continuous_difference
from odometry.trajectory import Trajectory


@dataclass(frozen=True)
class EvaluationConfig:
    """Settings of the evaluation.

    Attributes
    ----------
    horizon_m : float
        Wheel travel over which relative errors are taken.
    stride_m : float
        Wheel travel between the starts of two windows.
    """

    horizon_m: float = 5.0
    stride_m: float = 0.5

    def __post_init__(self) -> None:
        require_positive(self, "horizon_m", "stride_m")


@dataclass(frozen=True)
class RelativeErrors:
    """Errors of windows of equal wheel travel.

    Attributes
    ----------
    start_s : (K,)
        When each window starts.
    translation_per_m : (K,)
        Distance between the two end positions, both seen from the start, per metre of wheel
        travel.
    rotation_per_m : (K,)
        Absolute difference of the two turns, rad per metre of wheel travel; whole turns count,
        so that it may be above pi per horizon.
    """

    start_s: FloatArray
    translation_per_m: FloatArray
    rotation_per_m: FloatArray


def relative_errors(
    trajectory: Trajectory,
    reference: Trajectory,
    travel_s: FloatArray,
    travel_m: FloatArray,
    config: EvaluationConfig,
) -> RelativeErrors:
    """Compare motions over spatial horizons (CONVENTIONS, "Horizons and errors").

    Parameters
    ----------
    trajectory, reference : Trajectory
        Compared at the reference's stamps that the trajectory covers.
    travel_s, travel_m : (M,)
        Wheel travel over time.
    config : EvaluationConfig

    Returns
    -------
    RelativeErrors
        Without windows where the two have less than a horizon in common.
    """
    both = trajectory.covers(reference.stamps_s)
    if both.sum() < 2:
        return RelativeErrors(np.empty(0), np.empty(0), np.empty(0))
    stamps_s, true_poses = reference.stamps_s[both], reference.poses[both]
    poses = trajectory.at(stamps_s).poses
    travelled = np.interp(stamps_s, travel_s, travel_m)
    first, last = spatial_horizons(travelled, config.horizon_m, config.stride_m).T
    error = se2.between(
        se2.between(true_poses[first], true_poses[last]), se2.between(poses[first], poses[last])
    )
    yaw_errors = continuous_difference(poses[:, 2], true_poses[:, 2])
    length = travelled[last] - travelled[first]
    return RelativeErrors(
        stamps_s[first],
        np.hypot(error[:, 0], error[:, 1]) / length,
        np.abs(yaw_errors[last] - yaw_errors[first]) / length,
    )


def position_errors(trajectory: Trajectory, reference: Trajectory) -> tuple[FloatArray, FloatArray]:
    """Distance from the reference at its stamps that the trajectory covers: stamps, metres."""
    stamps_s = reference.stamps_s[trajectory.covers(reference.stamps_s)]
    difference = trajectory.at(stamps_s).poses - reference.at(stamps_s).poses
    return stamps_s, np.hypot(difference[:, 0], difference[:, 1])
