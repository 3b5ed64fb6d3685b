"""A filter whose heading is not known yet, and how measured poses determine it."""

import math
from typing import NamedTuple

import numpy as np

from odometry.arrays import FloatArray
from odometry.estimation.course import Course, Heading, aligned
from odometry.estimation.filter_event import FilterEvent
from odometry.estimation.measurement import Gaussian, Place, reference_point
from odometry.estimation.transition import GYRO_BIAS, STATES, YAW
from odometry.frames import Frame
from odometry.geometry.angles import wrap_one

INITIAL_YAW = "initial_yaw"  # kinds of events, whose values are the yaw and its sigma [rad]
LATER_YAW = "heading_found"
WIDE_RAD = math.radians(5.0)  # of a standard deviation: 0.9 m in 10 m


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
    if math.isfinite(pose[YAW]):
        heading: Heading | None = Heading(
            wrap_one(float(pose[YAW] - belief[0][YAW])),
            math.sqrt(float(pose_covariance[YAW, YAW])),
            course.reckoned_m,
            course.measured_m,
            position_sigma_m,
        )
        how = "a pose with a yaw came"
    else:
        heading = course.heading(position_sigma_m, by_gyroscope=math.isfinite(frame.yaw_rate_rad_s))
        heading = heading and _with_drift(heading, belief, frame.stamp_s - course.begin_s)
        how = f"by the course of {course.count} positions"
    if heading is not None:
        yaw = float(belief[0][YAW])
        turned = _turned(belief, heading, np.append(reckoned_m, yaw), lever_m)
        return Searched(turned, None, (_event(course, heading, frame, how),))
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
