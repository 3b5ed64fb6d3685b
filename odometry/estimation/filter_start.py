"""Where a filter starts: its first frame, anew at measured poses, and with an unknown heading."""

import math
from collections.abc import Sequence
from typing import NamedTuple

import numpy as np

from odometry.arrays import FloatArray
from odometry.estimation.course import UNKNOWN_YAW_VARIANCE, Course, Heading, aligned
from odometry.estimation.estimate import OF_TERRAIN, IcrBelief
from odometry.estimation.filter_event import FilterEvent
from odometry.estimation.measurement import Gaussian, Place, reference_point
from odometry.estimation.terrain_beliefs import OF_TERRAIN_BLOCK
from odometry.estimation.transition import GYRO_BIAS, STATES, YAW
from odometry.geometry.angles import wrap_one
from odometry.recording.frames import Frame

INITIAL_YAW = "initial_yaw"  # kinds of events, whose values are the yaw and its sigma [rad]
LATER_YAW = "heading_found"
WIDE_RAD = math.radians(5.0)  # of a standard deviation: 0.9 m in 10 m


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
    or a filter that has diverged, differ by about the same from pose to pose.
    """
    last = refused[-1]
    of_last_kind = [residual for residual in refused if len(residual) == len(last)]
    sigmas = np.sqrt(np.diag(pose_covariance))
    scaled = np.array(of_last_kind) / (sigmas if len(last) == 3 else sigmas[: len(last)])
    most = MOST_APART * float(np.linalg.norm(scaled[-1])) + MOST_SIGMAS
    near = np.linalg.norm(scaled - scaled[-1], axis=1) <= most
    return int(near.sum()) >= max(2.0, SHARE * len(refused))


def started_anew(
    belief: Gaussian,
    pose: FloatArray,
    pose_covariance: FloatArray,
    lever_m: Place,
    *,
    lost_yaw_rad: float = LOST_YAW_RAD,
) -> Gaussian:
    """The belief at a measured pose (3,), parts of which may be NaN; the rest stays."""
    mean, covariance = belief[0].copy(), np.zeros((STATES, STATES))
    covariance[3:, 3:] = belief[1][3:, 3:]
    covariance[:3, :3] = pose_covariance
    if math.isfinite(pose[YAW]):
        mean[YAW] = pose[YAW]
    else:
        covariance[YAW, YAW] = belief[1][YAW, YAW] + lost_yaw_rad**2
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
        f"{' and '.join(parts)} from the filter: it started again there (the poses jumped, or "
        "treads and gyroscope lost their way; until poses show which, the covariance covers both "
        "places)",
        (float(len(refused)),),
    )


class Searched(NamedTuple):
    """What a pose changes while the heading is searched; `course` is None once it is found."""

    belief: Gaussian
    course: Course | None
    events: tuple[FilterEvent, ...] = ()


def searched(
    course: Course,
    belief: Gaussian,
    frame: Frame,
    pose_covariance: FloatArray,
    lever_m: Place,
) -> Searched:
    """Take in a pose (3,) whose yaw, or whose position, may be NaN; `pose_covariance` is (3, 3).

    Dead reckoning has begun with a yaw of 0. A position adds to the search, and the estimate goes
    on from there, as its heading means nothing; a measured yaw ends the search.
    """
    pose = frame.pose
    if pose is None:
        return Searched(belief, course)
    placed = bool(np.isfinite(pose[:2]).all())
    # each position moved the estimate to itself: dead reckoning is what it moved since
    reckoned_m = (
        course.last_reckoned_m + reference_point(belief[0], lever_m) - course.last_measured_m
    )
    if placed:
        course = course.with_position(reckoned_m, pose[:2])
    position_sigma_m = math.sqrt(float(pose_covariance[0, 0]))
    heading: Heading | None
    turned_rad = 0.0  # deviation of what dead reckoning turned since the start, beside the heading
    if math.isfinite(pose[YAW]):
        heading = Heading(
            wrap_one(float(pose[YAW] - belief[0][YAW])),
            math.sqrt(float(pose_covariance[YAW, YAW])),
            course.reckoned_m,
            course.measured_m,
            position_sigma_m,
        )
        turned_rad = math.sqrt(max(float(belief[1][YAW, YAW]) - UNKNOWN_YAW_VARIANCE, 0.0))
        how = "a pose with a yaw came"
    else:
        heading = course.heading(position_sigma_m, by_gyroscope=math.isfinite(frame.yaw_rate_rad_s))
        heading = heading and _with_drift(heading, belief, frame.stamp_s - course.begin_s)
        how = f"by the course of {course.count} positions"
    if heading is not None:
        yaw = float(belief[0][YAW])
        at_start = heading._replace(sigma_rad=math.hypot(heading.sigma_rad, turned_rad))
        turned = _turned(belief, heading, np.append(reckoned_m, yaw), lever_m)
        return Searched(turned, None, (_event(course, at_start, frame, how),))
    if course.is_over:
        course = course.anew(frame.stamp_s)
    return Searched(_at(belief, pose[:2], pose_covariance, lever_m) if placed else belief, course)


def _with_drift(heading: Heading, belief: Gaussian, lasted_s: float) -> Heading:
    """The heading with what the gyroscope's bias may have turned dead reckoning by meanwhile.

    The course gives the yaw of about its middle; at either end it is off by half of that.
    """
    drift_rad = math.sqrt(float(belief[1][GYRO_BIAS, GYRO_BIAS])) * lasted_s / 2
    return heading._replace(sigma_rad=math.hypot(heading.sigma_rad, drift_rad))


def _event(course: Course, heading: Heading, frame: Frame, how: str) -> FilterEvent:
    """Of a yaw at the beginning, or, where the search began anew, of a turn of dead reckoning."""
    size = f"{math.degrees(heading.yaw_rad):.1f} +- {math.degrees(heading.sigma_rad):.1f} degrees"
    kind, text = INITIAL_YAW, f"the yaw at the start was found: {size} ({how})"
    if course.began_anew:
        kind = LATER_YAW
        text = f"the yaw was found late: the path up to here was turned by {size} ({how})"
    if heading.sigma_rad > WIDE_RAD:
        text += "; that is wide: places nearby are right, those farther on may be turned by as much"
    values = (heading.yaw_rad, heading.sigma_rad)
    return FilterEvent(kind, course.begin_s, frame.stamp_s, text, values)


def _turned(belief: Gaussian, heading: Heading, reckoned: FloatArray, lever_m: Place) -> Gaussian:
    """State estimate in the frame of the positions, its pose uncorrelated with the rest."""
    mean, covariance = belief[0].copy(), np.zeros((STATES, STATES))
    covariance[3:, 3:] = belief[1][3:, 3:]
    mean[:3], covariance[:3, :3] = aligned(heading, reckoned)
    mean[YAW] = wrap_one(float(mean[YAW]))
    mean[:2] -= reference_point(mean, lever_m) - mean[:2]
    return mean, covariance


def _at(
    belief: Gaussian, position_m: FloatArray, pose_covariance: FloatArray, lever_m: Place
) -> Gaussian:
    """State estimate moved to a measured position, whose direction from the robot is unknown."""
    mean, covariance = belief[0].copy(), belief[1].copy()
    mean[:2] += position_m - reference_point(mean, lever_m)
    covariance[:2], covariance[:, :2] = 0.0, 0.0
    covariance[:2, :2] = pose_covariance[:2, :2] + math.hypot(*lever_m) ** 2 * np.eye(2)
    return mean, covariance
