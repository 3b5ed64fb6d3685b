"""Errors of a trajectory against a reference, per metre of wheel travel and in position."""

from dataclasses import dataclass

import numpy as np

from odometry.arrays import FloatArray, IntArray
from odometry.config import require_positive
from odometry.geometry import se2
from odometry.geometry.angles import continuous_difference
from odometry.trajectory import Trajectory
from odometry.windows.travel.horizons import spatial_horizons

LEAST_SPREAD = 0.1  # of the reach: positions closer than this give no heading


def course_headings(
    poses: FloatArray,
    true_poses: FloatArray,
    travelled_m: FloatArray,
    rows: IntArray,
    reach_m: float,
) -> FloatArray:
    """Yaw (K,) of a reference at some rows, from the positions around each.

    The part of the trajectory within `reach_m` of wheel travel before and after a row is turned
    onto the reference's positions there by least squares (the plane's case of Umeyama 1991, IEEE
    TPAMI 13(4), without scale). A heading error that grows evenly with travel is 0 at the middle
    of such a part, so that it turns the part's ends against each other and not the part: errors
    measured from this heading are neither hidden by the alignment nor added to by it.

    Parameters
    ----------
    poses, true_poses : (N, 3)
        Of the trajectory and of the reference at the same stamps; the reference's yaw is not read.
    travelled_m : (N,)
        Wheel travel at each stamp, not decreasing.
    rows : (K,)
        Rows at which the heading is wanted.
    reach_m : float

    Returns
    -------
    (K,)
        NaN where either side is shorter than `reach_m`, or where the positions spread over less
        than LEAST_SPREAD of it.
    """
    begins = np.searchsorted(travelled_m, travelled_m[rows] - reach_m - 1e-9)
    ends = np.searchsorted(travelled_m, travelled_m[rows] + reach_m + 1e-9, side="right")
    ours = poses[:, 0] + 1j * poses[:, 1]
    true = true_poses[:, 0] + 1j * true_poses[:, 1]
    ours, true = ours - ours[0], true - true[0]  # smaller numbers, less rounding
    count = ends - begins
    our_mean, true_mean = (_sums(line, begins, ends) / count for line in (ours, true))
    turned = _sums(np.conj(ours) * true, begins, ends) / count - np.conj(our_mean) * true_mean
    variance = _sums(np.abs(true) ** 2, begins, ends) / count - np.abs(true_mean) ** 2
    whole = travelled_m[rows] - travelled_m[0] >= reach_m - 1e-9
    whole &= travelled_m[-1] - travelled_m[rows] >= reach_m - 1e-9
    known = whole & (variance > (LEAST_SPREAD * reach_m) ** 2) & (np.abs(turned) > 0)
    return np.where(known, poses[rows, 2] + np.angle(turned), np.nan)


def _sums(values: FloatArray, begins: IntArray, ends: IntArray) -> FloatArray:
    """Sums (K,) of values from each begin up to, not including, each end."""
    running = np.append(0.0, np.cumsum(values))
    return np.asarray(running[ends] - running[begins])


@dataclass(frozen=True)
class EvaluationConfig:
    """Settings of the evaluation.

    Attributes
    ----------
    horizon_m : float
        Wheel travel over which relative errors are taken.
    stride_m : float
        Wheel travel between the starts of two windows.

    Examples
    --------
    >>> import odometry
    >>> odometry.EvaluationConfig(horizon_m=2.0)
    EvaluationConfig(horizon_m=2.0, stride_m=0.5)
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
        Distance between the two end positions, both in the frame of the start, per metre of wheel
        travel.
    rotation_per_m : (K,)
        Absolute difference of the two turns, rad per metre of wheel travel; whole turns count,
        so that it may be above pi per horizon. NaN where the reference has no yaw.
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
    *,
    reference_yaw_rad: FloatArray | None = None,
    reference_part: IntArray | None = None,
) -> RelativeErrors:
    """Compare motions over spatial horizons (data/README.md, Symbols and frame).

    Where the reference has no yaw at the start of a window, its heading there is the one that its
    course gives over a horizon before and a horizon after, see `course.course_headings`; where
    that gives none, there is no window.

    Parameters
    ----------
    trajectory, reference : Trajectory
        Compared at the reference's stamps that the trajectory covers. The yaw of the reference
        may be NaN.
    travel_s, travel_m : (M,)
        Wheel travel over time.
    config : EvaluationConfig
    reference_yaw_rad : (N,), optional
        Yaw of the reference with whole turns counted, as `windows.turns.counted_turns` gives it.
        Without it the error of yaw is taken to change by less than half a turn from one stamp of
        the reference to the next.
    reference_part : (N,), optional
        Numbers of parts between which whole turns are not known: windows from one to another have
        no rotation.

    Returns
    -------
    RelativeErrors
        Without windows where the two have less than a horizon in common.

    Examples
    --------
    >>> import numpy as np
    >>> import odometry
    >>> stamps_s = np.linspace(0.0, 20.0, 21)
    >>> along = np.zeros((21, 3))
    >>> along[:, 0] = stamps_s  # 1 m/s
    >>> measured = odometry.Trajectory(stamps_s, along)
    >>> estimated = odometry.Trajectory(stamps_s, along * (1.1, 1.0, 1.0))  # a tenth too far
    >>> config = odometry.EvaluationConfig(horizon_m=5.0)
    >>> errors = odometry.relative_errors(estimated, measured, stamps_s, stamps_s, config)
    >>> f"{errors.translation_per_m.mean():.2f} m per m"
    '0.10 m per m'
    """
    both = trajectory.covers(reference.stamps_s)
    if both.sum() < 2:
        return RelativeErrors(np.empty(0), np.empty(0), np.empty(0))
    stamps_s, true_poses = reference.stamps_s[both], reference.poses[both].copy()
    poses = trajectory.at(stamps_s).poses
    travelled = np.interp(stamps_s, travel_s, travel_m)
    first, last = spatial_horizons(travelled, config.horizon_m, config.stride_m).T
    if reference_yaw_rad is None:
        yaw_errors = _continuous_where_measured(poses[:, 2], true_poses[:, 2])
    else:
        own = np.unwrap(trajectory.poses[:, 2])
        yaw_errors = np.interp(stamps_s, trajectory.stamps_s, own) - reference_yaw_rad[both]
    headings = true_poses[first, 2]
    unknown = ~np.isfinite(headings)
    headings[unknown] = course_headings(
        poses, true_poses, travelled, first[unknown], config.horizon_m
    )
    known = np.isfinite(headings)
    first, last = first[known], last[known]
    true_starts = np.column_stack([true_poses[first, :2], headings[known]])
    true_ends, ends = (
        _seen_from(true_starts, true_poses[last]),
        _seen_from(poses[first], poses[last]),
    )
    length = travelled[last] - travelled[first]
    turned = yaw_errors[last] - yaw_errors[first]
    if reference_part is not None:
        part = reference_part[both]
        turned = np.where(part[first] == part[last], turned, np.nan)
    return RelativeErrors(
        stamps_s[first], np.hypot(*(ends - true_ends).T) / length, np.abs(turned) / length
    )


def _seen_from(poses: FloatArray, places: FloatArray) -> FloatArray:
    """Positions (K, 2) of places (K, 2 or more) in the frames of poses (K, 3)."""
    return se2.transform(se2.inverse(poses), places[:, :2])


def _continuous_where_measured(yaw: FloatArray, true_yaw: FloatArray) -> FloatArray:
    """Differences (N,) of yaw with whole turns counted, NaN where it was not measured."""
    differences = np.full(len(yaw), np.nan)
    measured = np.isfinite(true_yaw)
    differences[measured] = continuous_difference(yaw[measured], true_yaw[measured])
    return differences


def position_errors(trajectory: Trajectory, reference: Trajectory) -> tuple[FloatArray, FloatArray]:
    """Stamps (K,) of the reference that a trajectory covers, and its distance (K,) there [m].

    Examples
    --------
    >>> import numpy as np
    >>> import odometry
    >>> stamps_s = np.array([0.0, 1.0])
    >>> measured = odometry.Trajectory(stamps_s, np.array([[0.0, 0.0, 0.0], [1.0, 0.0, 0.0]]))
    >>> odometry.position_errors(measured.moved(np.array([0.0, 0.5, 0.0])), measured)
    (array([0., 1.]), array([0.5, 0.5]))
    """
    stamps_s = reference.stamps_s[trajectory.covers(reference.stamps_s)]
    difference = trajectory.at(stamps_s).poses - reference.at(stamps_s).poses
    return stamps_s, np.hypot(difference[:, 0], difference[:, 1])
