"""How measured yaw and measured course belong together, within pose.csv alone."""

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np

from odometry.arrays import BoolArray, FloatArray
from odometry.checks.evidence.motion import Motion
from odometry.checks.statistics.relation import relation

FAR = 0.3  # share of the usual longest distance from which the course of a window is known
STRAIGHT_RAD = (0.3, 0.6, 1.0)  # windows that turn less have a course; the first with enough
ON_THE_SPOT = 0.15  # share of the tread travel that is common: below, the robot has no course
LEAST_WINDOWS = 10
CONSISTENT = 0.8  # concentration from which yaw and course belong together

HELD = 0.9  # correlation of turns that are the same
OF_GYROSCOPE = (0.7, 1.4)  # ratio of turns in one unit
# Turns for each rad that treads without slip say: 0.1 to 1 of robots that were measured. In degrees
# they are 57 times as large.
OF_TREADS = (0.08, 1.4)
NEVER = 8.0

# What the column yaw may hold instead of the heading [rad, counter-clockwise].
READINGS: dict[str, Callable[[FloatArray], FloatArray]] = {
    "radians": lambda yaw: yaw,
    "degrees": np.radians,
    "radians, reversed": np.negative,
    "degrees, reversed": lambda yaw: -np.radians(yaw),
}


@dataclass(frozen=True)
class Heading:
    """One way to read the column yaw, and how well it agrees with the course.

    Attributes
    ----------
    reading : str
        Of `READINGS`.
    concentration : float
        Of course less yaw, doubled so that driving backwards counts as well: 1 where all windows
        agree, near 0 where there is no relation.
    offset_rad : float
        Course less yaw while driving forwards (by the treads), in (-pi, pi].
    forwards : float
        How clearly the treads say what forwards is: 1 always, 0 as often this as that way.
    windows : int
    """

    reading: str
    concentration: float
    offset_rad: float
    forwards: float
    windows: int


def headings(motion: Motion, turn_rad: FloatArray) -> dict[str, Heading]:
    """All readings of yaw; empty where too few windows are far enough and straight.

    Parameters
    ----------
    motion : Motion
    turn_rad : (K,)
        By how much the robot turns, by gyroscope or yaw.
    """
    far = far_and_straight(motion, turn_rad)
    if far is None:
        return {}
    course, ahead = motion.course_rad[far], motion.mean_m[far]
    return {
        name: _heading(name, read(motion.yaw_rad[far]), course, ahead)
        for name, read in READINGS.items()
    }


def turns_in_radians(motion: Motion, turn_rad: FloatArray, track_width_m: float) -> bool:
    """Whether raw yaw turns by what the gyroscope, or else the treads, say: it is in radians.

    Parameters
    ----------
    motion : Motion
        Of the yaw as it is in the file.
    turn_rad : (K,)
        By the gyroscope; of no use where it is NaN or the yaw itself, for lack of one.
    track_width_m : float
    """
    by_treads = relation(motion.turn_rad, motion.difference_m / track_width_m)
    if by_treads is not None and by_treads.certain() and abs(by_treads.slope) > NEVER:
        return False
    measured = np.isfinite(motion.gyroscope_rad).any()
    found = relation(motion.turn_rad, turn_rad) if measured else by_treads
    low, high = OF_GYROSCOPE if measured else OF_TREADS
    return found is not None and found.correlation > HELD and low < found.slope < high


def far_and_straight(motion: Motion, turn_rad: FloatArray) -> BoolArray | None:
    """Windows (K,) whose course is known, the straightest that suffice; None where too few are."""
    distance = motion.distance_m
    known = np.isfinite(distance) & np.isfinite(motion.yaw_rad).all(axis=1)
    if known.sum() < LEAST_WINDOWS:
        return None
    far = known & (distance > FAR * np.quantile(distance[known], 0.95))
    faster = np.maximum(np.abs(motion.left_m), np.abs(motion.right_m))
    if np.nansum(np.abs(motion.mean_m[far])) < ON_THE_SPOT * np.nansum(faster[far]):
        return None
    for limit in STRAIGHT_RAD:
        chosen = far & ~(np.abs(turn_rad) > limit)
        if chosen.sum() >= LEAST_WINDOWS * (1.5 if limit < STRAIGHT_RAD[-1] else 1.0):
            return np.asarray(chosen)
    return None


def along_m(motion: Motion, heading: Heading) -> FloatArray:
    """Measured displacement (K,) along the axis of the robot that is nearest to its yaw."""
    return np.asarray(motion.distance_m * np.cos(_off_axis(motion, heading)))


def across_m(motion: Motion, heading: Heading) -> FloatArray:
    """Measured displacement (K,) to the left of that axis."""
    return np.asarray(motion.distance_m * np.sin(_off_axis(motion, heading)))


def middle_yaw(motion: Motion, heading: Heading) -> FloatArray:
    """Measured yaw (K,) in the middle of each window, as the reading has it."""
    return middle_rad(READINGS[heading.reading](motion.yaw_rad))


def _off_axis(motion: Motion, heading: Heading) -> FloatArray:
    middle = middle_yaw(motion, heading)
    axis = (heading.offset_rad + np.pi / 2) % np.pi - np.pi / 2
    return np.asarray(motion.course_rad - middle - axis)


def middle_rad(yaw: FloatArray) -> FloatArray:
    """Direction (K,) in the middle of two (K, 2)."""
    return np.asarray(np.angle(np.exp(1j * yaw).sum(axis=1)))


def _heading(name: str, yaw: FloatArray, course: FloatArray, ahead: FloatArray) -> Heading:
    middle = middle_rad(yaw)
    doubled = np.mean(np.exp(2j * (course - middle)))
    offset = float(np.angle(doubled) / 2)
    along = np.cos(course - middle - offset)
    forwards = float(np.sum(along * ahead) / max(np.sum(np.abs(along * ahead)), 1e-12))
    if forwards < 0:
        offset += np.pi if offset <= 0 else -np.pi
    return Heading(name, float(np.abs(doubled)), offset, abs(forwards), len(course))
