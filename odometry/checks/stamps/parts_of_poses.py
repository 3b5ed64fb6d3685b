"""Positions or yaw of pose.csv that are late alone: two sources that were written as one pose.

Positions of a receiver stand beside the yaw of an IMU or a compass, each with a delay of its own.
"""

import numpy as np

from odometry.arrays import FloatArray
from odometry.checks.evidence.evidence import Evidence
from odometry.checks.findings.finding import Finding, Level
from odometry.checks.findings.undo import positions_sooner, yaw_sooner
from odometry.checks.stamps.late_positions import lag_beside_yaw
from odometry.checks.statistics.lag import Lag
from odometry.checks.statistics.relation import relation
from odometry.geometry.angles import wrap

ON_TIME_S = 0.15  # good poses are early by up to 0.11 s once constant delays are removed
SAME_S = 0.15  # of one delay that two sensors measure
# Steps by which the course is compared with yaw, and those that count. Slower ones are noise.
STEP_S, LEAST_M, LEAST_M_S, LEAST_RAD_S = 0.6, 0.1, 0.2, 0.1
CERTAIN = 3.0  # standard deviations of the delay of the course
# Robots that slide outwards in turns go where they pointed a little before: by 0.02 to 0.38 s in 26
# real recordings, whose positions are on time. Less is no delay of positions.
SLIDING_S = 0.45
NEAR = 0.75  # of the delay of the speed, that the course has at least
EARLY_S = 0.1  # that a course is early, which no sliding does


def late_part(evidence: Evidence, lags: dict[tuple[str, str], Lag]) -> Finding | None:
    """Which of positions and yaw is late, by the lags of turns of each pair of sensors.

    None where that cannot be determined.
    """
    turns, speed = (
        turns_in_step(evidence, lags),
        lag_beside_yaw(evidence, lags.get(("pose", "treads"))),
    )
    if turns is None or speed is None:
        return None
    if abs(speed.seconds) < ON_TIME_S and abs(turns.seconds) > ON_TIME_S:
        along = f"the speed between positions {speed.seconds:+.2f} s against that of the treads"
        return yaw_late(turns, along)
    if abs(turns.seconds) < ON_TIME_S and _course_is_late(evidence, speed.seconds):
        return _positions_late(turns, speed)
    return None


def turns_in_step(evidence: Evidence, lags: dict[tuple[str, str], Lag]) -> Lag | None:
    """The lag of measured yaw behind a gyroscope that turns in step with the treads, else None.

    Also None of yaw in degrees, which has another cause before its stamps.
    """
    wheels, by_gyroscope, by_treads = (
        lags.get(pair)
        for pair in (("treads", "gyroscope"), ("pose", "gyroscope"), ("pose", "treads"))
    )
    if evidence.yaw_in_degrees or wheels is None or by_gyroscope is None or by_treads is None:
        return None
    alike = abs(by_gyroscope.seconds - by_treads.seconds) < SAME_S
    return by_gyroscope if abs(wheels.seconds) < ON_TIME_S and alike else None


def yaw_late(turns: Lag, along: str) -> Finding:
    """Yaw that is late alone, by its turns, with words for the positions, which are not."""
    word = _word(turns)
    return Finding(
        "yaw_late",
        Level.WARNING,
        f"measured yaw is {abs(turns.seconds):.2f} +- {turns.sigma_s:.2f} s {word} against "
        f"gyroscope and treads, and {along}",
        f"Yaw of pose.csv is {word} and its positions are not: they come from two sources, one of "
        "which is delayed or filtered",
        f"Give yaw the stamps of its sensor (subtract {turns.seconds:+.2f} s), or leave it empty",
        mend=yaw_sooner(turns.seconds),
    )


def _positions_late(turns: Lag, speed: Lag) -> Finding:
    word = _word(speed)
    return Finding(
        "positions_late",
        Level.WARNING,
        f"the speed between positions is {abs(speed.seconds):.2f} +- {speed.sigma_s:.2f} s {word} "
        f"against that of the treads, and so is their course against measured yaw, which turns "
        f"{turns.seconds:+.2f} s against the gyroscope",
        f"Positions of pose.csv are {word} and its yaw is not: they come from two sources (a "
        "receiver whose positions are delayed or filtered, beside the yaw of an IMU)",
        f"Give positions the stamps of their sensor (subtract {speed.seconds:+.2f} s)",
        mend=positions_sooner(speed.seconds),
    )


def _word(lag: Lag) -> str:
    return "late" if lag.seconds > 0 else "early"


def _course_is_late(evidence: Evidence, seconds: float) -> bool:
    """Whether the course of positions is late behind yaw, by about as much as their speed.

    A robot that follows its treads late goes where it points at that moment, but for its sliding. A
    sensor ahead of the centre turns the course as well, by how far ahead it is over the speed: both
    are estimated.
    """
    found = _steps(evidence)
    if found is None:
        return False
    aside_rad, turn_rad_s, speed_m_s = found
    of_course = relation(aside_rad, -turn_rad_s, turn_rad_s / speed_m_s)
    if of_course is None or not of_course.certain(0, CERTAIN):
        return False
    if seconds < 0:
        return seconds < of_course.slope < -EARLY_S
    return max(NEAR * seconds, SLIDING_S) < of_course.slope < seconds + SLIDING_S


def _steps(evidence: Evidence) -> tuple[FloatArray, FloatArray, FloatArray] | None:
    """Course less yaw, either way (K,), yaw rate and signed speed of steps in which it turns."""
    pose, used = evidence.run.pose, evidence.poses_used
    if pose is None or used is None:
        return None
    used = used & np.isfinite(pose.stack("x", "y", "yaw")).all(axis=1)
    stamps_s, positions = pose.stamps_s[used], pose.stack("x", "y")[used]
    yaw = np.unwrap(np.radians(pose["yaw"][used]) if evidence.yaw_in_degrees else pose["yaw"][used])
    end = np.searchsorted(stamps_s, stamps_s + STEP_S)
    begin = np.flatnonzero(end < len(stamps_s))
    end = end[begin]
    lasts_s = stamps_s[end] - stamps_s[begin]
    moved_m, turn_rad_s = positions[end] - positions[begin], (yaw[end] - yaw[begin]) / lasts_s
    middle_s = (stamps_s[begin] + stamps_s[end]) / 2
    way_m_s = np.interp(middle_s, evidence.stamps_s, evidence.speeds_m_s.mean(axis=1))
    counts = (
        (lasts_s < 2 * STEP_S)
        & (np.hypot(*moved_m.T) > LEAST_M)
        & (np.abs(way_m_s) > LEAST_M_S)
        & (np.abs(turn_rad_s) > LEAST_RAD_S)
    )
    ahead = np.interp(middle_s, stamps_s, yaw) + np.pi * (way_m_s < 0)
    aside_rad = wrap(np.arctan2(moved_m[:, 1], moved_m[:, 0]) - ahead)
    return aside_rad[counts], turn_rad_s[counts], way_m_s[counts]
