"""Positions that swing in turns: the place of the sensor is not stated, or not that stated."""

from collections.abc import Iterator

import numpy as np

from odometry.arrays import FloatArray
from odometry.checks.evidence.evidence import Evidence
from odometry.checks.evidence.heading import middle_rad
from odometry.checks.evidence.motion import Motion
from odometry.checks.evidence.way_direction import way_direction_rad
from odometry.checks.findings.finding import Finding, Level
from odometry.checks.findings.undo import moved
from odometry.checks.poses.course import OFF_RAD
from odometry.checks.statistics.relation import pieces, relation
from odometry.checks.treads.one_motion import motion_alone

LEAST_ARM_M = 0.6
TIMES = 8.0  # standard deviations of the swing
LASTING = 0.4  # share of the swing that each piece of the recording has
SIGN = 0.35  # share of the stated place by which a place with its signs turned round may be off


def far_sensor(evidence: Evidence) -> Iterator[Finding]:
    """A sensor far from the centre swings sideways, or forwards, with every turn.

    In circles of one radius a place to the side is a scale of the treads as well.
    """
    if motion_alone(evidence) is not None or evidence.positions_measured is None:
        return
    m = evidence.motion
    turn = m.gyroscope_rad if evidence.yaw_rate is not None else m.turn_rad
    yaw = m.yaw_rad if evidence.yaw_measured else evidence.gyroscope_yaw(m)
    axis_rad = way_direction_rad(m, yaw, turn)
    if (arm_m := _arm_m(m, middle_rad(yaw) + axis_rad, turn, _limit_m(evidence))) is None:
        return
    stated_m = evidence.run.sensors.pose_m
    x_m, y_m = map(float, arm_m)
    place_m = arm_m + (stated_m or (0.0, 0.0, 0.0))[:2]
    near_axis_rad = axis_rad if abs(axis_rad) < OFF_RAD else 0.0  # more has a name of its own
    yield Finding(
        "far_sensor",
        Level.WARNING,
        f"measured positions{_moved_from(stated_m)} swing in turns like a point that lies "
        f"{_place(x_m, y_m)} the centre of the robot; more than {_limit_m(evidence):.2f} m is far",
        _cause(arm_m, stated_m),
        f"State its place: [sensors] pose = [{place_m[0]:.2f}, {place_m[1]:.2f}, "
        f"{(stated_m or (0.0,))[-1]:.1f}]",
        mend=moved(x_m, y_m, near_axis_rad) if evidence.yaw_measured else None,
    )


def _arm_m(m: Motion, axis_rad: FloatArray, turn: FloatArray, limit_m: float) -> FloatArray | None:
    """Place (2,) of the measured point of a robot that points to (K,); None if it is near."""
    off_rad = m.course_rad - axis_rad
    along, across = m.distance_m * np.cos(off_rad), m.distance_m * np.sin(off_rad)
    sideways, forward = relation(across, turn), relation(along, m.mean_m, turn)
    if sideways is None or forward is None:
        return None
    x_m, y_m = sideways.slope, -float(forward.coefficients[1])
    sure = sideways.certain(0, TIMES), forward.certain(1, TIMES)
    far = max(abs(x_m) * sure[0], abs(y_m) * sure[1])
    if far <= limit_m:
        return None
    place = 0 if far == abs(x_m) else 1
    columns = (turn,) if place == 0 else (m.mean_m, turn)
    fits = pieces((across, along)[place], *columns)
    size = (x_m, -y_m)[place]
    swings = [of.coefficients[place] / size for of in fits if of.certain(place)]
    lasts = len(swings) > 1 and min(swings) > LASTING
    return np.array([x_m, y_m]) if lasts else None


def _limit_m(evidence: Evidence) -> float:
    return max(LEAST_ARM_M, (evidence.run.robot.length or 1.0) / 2)


def _moved_from(stated_m: tuple[float, ...] | None) -> str:
    if stated_m is None:
        return ""
    return f", moved from [sensors] pose = {list(stated_m)} to the centre,"


def _cause(arm_m: FloatArray, stated_m: tuple[float, ...] | None) -> str:
    or_else = (
        "the frame of the poses is not that of the robot, or positions are late against yaw "
        "(filtered)"
    )
    if stated_m is None:
        return f"The sensor is mounted far from the centre (a lever arm), or {or_else}"
    stated = np.array(stated_m[:2])
    turned_round = np.hypot(*(arm_m + 2 * stated)) < SIGN * np.hypot(*stated)
    signs = " with its signs turned round (x is forward, y to the left)" if turned_round else ""
    return f"[sensors] pose of run.toml is not the place of the sensor{signs}, or {or_else}"


def _place(x_m: float, y_m: float) -> str:
    """A place in the robot frame in words, up to "the centre"."""
    along = f"{abs(x_m):.2f} m {'ahead of' if x_m >= 0 else 'behind'}"
    return f"{along} and {abs(y_m):.2f} m to the {'left' if y_m >= 0 else 'right'} of"
