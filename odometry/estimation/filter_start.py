"""The estimate of a filter at its first frame, and where it starts anew at measured poses."""

import math
from collections.abc import Sequence

import numpy as np

from odometry.arrays import FloatArray
from odometry.estimation.course import UNKNOWN_YAW_VARIANCE, Course
from odometry.estimation.estimate import OF_TERRAIN, IcrBelief
from odometry.estimation.filter_event import FilterEvent
from odometry.estimation.measurement import Gaussian, Place, reference_point
from odometry.estimation.terrain_beliefs import OF_TERRAIN_BLOCK
from odometry.estimation.transition import GYRO_BIAS, STATES, YAW
from odometry.frames import Frame


def first_belief(
    frame: Frame,
    of_terrain: IcrBelief,
    pose_covariance: FloatArray,
    lever_m: Place,
    *,
    bias_sigma_rad_s: float,
    yaw_sigma_rad: float | None,
) -> tuple[Gaussian, Course | None]:
    """Mean (9,) and covariance (9, 9), and the search for the heading where that is not known.

    Parameters
    ----------
    frame : Frame
        Where it has no pose, the filter starts at the origin.
    of_terrain : IcrBelief
    pose_covariance : (3, 3)
        Of a measured pose.
    lever_m : (x, y)
        Place of the measured point in the robot frame.
    bias_sigma_rad_s : float
        Standard deviation of the gyroscope's bias; 0 where it is not used.
    yaw_sigma_rad : float, optional
        Standard deviation of the yaw where it is not that of a measured one.
    """
    pose = np.full(3, math.nan) if frame.pose is None else frame.pose
    pose = np.where(np.isfinite(pose), pose, math.nan)
    placed, headed = not np.isnan(pose[:2]).any(), not math.isnan(pose[YAW])
    mean, covariance = np.zeros(STATES), np.zeros((STATES, STATES))
    covariance[:3, :3] = pose_covariance
    if headed:
        mean[YAW] = pose[YAW]
    if placed:
        mean[:2] = pose[:2] - reference_point(mean, lever_m)
    course = None
    if placed and not headed:
        course = Course.begun(frame.stamp_s, pose[:2], pose[:2])
        covariance[YAW, YAW] = UNKNOWN_YAW_VARIANCE
    elif yaw_sigma_rad is not None:
        covariance[YAW, YAW] = yaw_sigma_rad**2
    mean[OF_TERRAIN] = *of_terrain.icrs, *of_terrain.alphas
    covariance[OF_TERRAIN_BLOCK] = of_terrain.covariance
    covariance[GYRO_BIAS, GYRO_BIAS] = bias_sigma_rad_s**2
    return (mean, covariance), course


MOST_APART = 0.4  # of the last residual: refused poses that agree lie no farther from it
MOST_SIGMAS = 4.0
SHARE = 0.6  # of the refused poses that must agree with the last
REINITIALISED = "reinitialised"  # kind of the event, whose value is the number of refused poses
LOST_YAW_RAD = 0.2  # how far the yaw may be off where positions alone were refused


def agree(refused: Sequence[FloatArray], pose_covariance: FloatArray) -> bool:
    """Whether refused poses agree with each other, by their residuals (m,).

    Outliers differ from each other as much as from the filter; poses that jumped and stayed,
    or a filter that lost its way, differ by about the same from pose to pose.
    """
    last = refused[-1]
    alike = [residual for residual in refused if len(residual) == len(last)]
    sigmas = np.sqrt(np.diag(pose_covariance))
    scaled = np.array(alike) / (sigmas if len(last) == 3 else sigmas[: len(last)])
    most = MOST_APART * float(np.linalg.norm(scaled[-1])) + MOST_SIGMAS
    near = np.linalg.norm(scaled - scaled[-1], axis=1) <= most
    return int(near.sum()) >= max(2.0, SHARE * len(refused))


def started_anew(
    belief: Gaussian, pose: FloatArray, pose_covariance: FloatArray, lever_m: Place
) -> Gaussian:
    """The belief at a measured pose (3,), parts of which may be NaN; the rest stays."""
    mean, covariance = belief[0].copy(), np.zeros((STATES, STATES))
    covariance[3:, 3:] = belief[1][3:, 3:]
    covariance[:3, :3] = pose_covariance
    if math.isfinite(pose[YAW]):
        mean[YAW] = pose[YAW]
    else:
        covariance[YAW, YAW] = belief[1][YAW, YAW] + LOST_YAW_RAD**2
    if np.isfinite(pose[:2]).all():
        mean[:2] = pose[:2] - (reference_point(mean, lever_m) - mean[:2])
    else:
        covariance[:2, :2] = belief[1][:2, :2]
    return mean, covariance


def new_start_event(refused: Sequence[FloatArray], stamp_s: float) -> FilterEvent:
    """The event of a new start, by the residuals (m,) of refused poses in a row."""
    last = refused[-1]
    parts = [] if len(last) == 1 else [f"{math.hypot(*last[:2]):.2f} m"]
    if len(last) != 2:
        parts.append(f"{math.degrees(abs(last[-1])):.1f} degrees")
    return FilterEvent(
        REINITIALISED,
        stamp_s,
        stamp_s,
        f"{len(refused)} poses in a row were refused and agreed with each other, "
        f"{' and '.join(parts)} from the filter: it started anew there (the poses jumped, or "
        "treads and gyroscope lost their way)",
        (float(len(refused)),),
    )
