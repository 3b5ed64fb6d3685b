"""A filter whose heading is not known yet, and what measured poses tell it."""

import math
from typing import NamedTuple

import numpy as np

from odometry.arrays import FloatArray
from odometry.estimation.course import Course, Heading, aligned
from odometry.estimation.filter_event import FilterEvent
from odometry.estimation.measurement import Gaussian, Place, reference_point
from odometry.estimation.transition import STATES, YAW
from odometry.frames import Frame
from odometry.geometry.angles import wrap_one

INITIAL_YAW = "initial_yaw"  # kind of the event, whose values are the yaw and its sigma [rad]


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
    """Take in a pose whose yaw, or whose position, may be NaN.

    The belief is dead reckoning that begins with a yaw of 0: a position adds to the search, a
    measured yaw ends it.
    """
    if frame.pose is None:
        return Searched(belief, course)
    pose, by_gyroscope = frame.pose, math.isfinite(frame.yaw_rate_rad_s)
    reckoned_m = reference_point(belief[0], lever_m)
    if np.isfinite(pose[:2]).all():
        course = course.with_position(reckoned_m, pose[:2])
    position_sigma_m = math.sqrt(float(pose_covariance[0, 0]))
    if math.isfinite(pose[YAW]):
        heading = Heading(
            wrap_one(float(pose[YAW] - belief[0][YAW])),
            math.sqrt(float(pose_covariance[YAW, YAW])),
            course.reckoned_m,
            course.measured_m,
            position_sigma_m,
        )
        how = "a pose with a yaw came"
    else:
        found = course.heading(position_sigma_m, by_gyroscope=by_gyroscope)
        if found is None:
            return Searched(belief, course)
        heading, how = found, f"from the course of {course.count} positions"
    event = FilterEvent(
        INITIAL_YAW,
        course.begin_s,
        frame.stamp_s,
        f"initial yaw {math.degrees(heading.yaw_rad):.1f} degrees, "
        f"+- {math.degrees(heading.sigma_rad):.1f}: {how}",
        (heading.yaw_rad, heading.sigma_rad),
    )
    return Searched(_turned(belief, heading), None, (event,))


def _turned(belief: Gaussian, heading: Heading) -> Gaussian:
    """The belief in the frame of the positions, its pose apart from the rest."""
    mean, covariance = belief[0].copy(), np.zeros((STATES, STATES))
    covariance[3:, 3:] = belief[1][3:, 3:]
    mean[:3], covariance[:3, :3] = aligned(heading, mean[:3])
    mean[YAW] = wrap_one(float(mean[YAW]))
    return mean, covariance
