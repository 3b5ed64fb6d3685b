"""Offsets of the course from measured yaw: whether there is one, all along and everywhere."""

import numpy as np

from odometry.arrays import FloatArray
from odometry.checks.evidence.evidence import Evidence
from odometry.checks.evidence.heading import (
    Heading,
    across_m,
    along_m,
    far_and_straight,
    headings,
    middle_yaw,
)
from odometry.checks.evidence.motion import Motion
from odometry.checks.statistics.relation import relation

LEAST_SPANS = 30
PIECES = 8  # of the recording, in each of which yaw has one offset to the course
PIECE_HELD = 0.9  # concentration in a piece
OFFSETS_RAD = np.radians(25)  # between pieces
MOST_TURN_RAD = 1.0  # within a window that has a course
POOR = 0.75  # concentration; 0.80 and more in recordings whose distances go with the treads
STEADY = 0.96  # correlation of distances; on ice, where courses leave yaw, it is 0.93 and less
LEAST_WINDOWS = 20
# Share of the motion along yaw, beside an arm: 0.6 and more of slow robots that spin, whose course
# noise hides; 0.1 and less of a yaw that is read the wrong way.
BY_YAW = 0.5
HOLDS, MOST_APART_RAD = 0.6, np.radians(25)  # of an offset, and at most, by which parts differ
SURELY_RAD = np.radians(3)  # standard deviation


def yaw_wanders(evidence: Evidence) -> str:
    """Yaw that fits the course in each piece of the recording, with another offset in each.

    Beside what the robot slips sideways in turns: its course is off its yaw by an arm times how
    tight the turns of a piece are.
    """
    m, found = evidence.motion, []
    count = min(PIECES, len(m) // LEAST_SPANS)
    for rows in np.array_split(np.arange(len(m)), max(count, 1)):
        piece = m.rows(rows)
        heading = headings(piece, evidence.turn_rad(piece)).get("radians")
        if heading is not None and heading.concentration > PIECE_HELD:
            found.append((heading.offset_rad, _tightness(evidence, piece, heading)))
    if len(found) < max(count, PIECES) / 2:
        return ""
    arm_m = _arm_m(evidence)
    offsets = np.array([offset - arm_m * tightness for offset, tightness in found])
    middle = np.angle(np.exp(2j * offsets).sum()) / 2
    away = np.angle(np.exp(2j * (offsets - middle))) / 2
    if np.ptp(away) < OFFSETS_RAD:
        return ""
    return (
        f"yaw of pose.csv fits its course with offsets of {np.degrees(away.min()):+.0f} to "
        f"{np.degrees(away.max()):+.0f} degrees in pieces of the recording"
    )


def _tightness(evidence: Evidence, piece: Motion, heading: Heading) -> float:
    """How much a piece turns for its way [rad/m], in the windows that its offset is taken from."""
    turn = evidence.turn_rad(piece)
    used = far_and_straight(piece, turn)
    known = np.isfinite(turn) & (False if used is None else used)
    return _proportion(turn[known], along_m(piece, heading)[known])


def _arm_m(evidence: Evidence) -> float:
    """Motion aside for each turn, beside what an offset of yaw explains of both."""
    m = evidence.motion
    turn = evidence.turn_rad(m)
    heading = headings(m, turn).get("radians")
    if heading is None:
        return 0.0
    across, along = across_m(m, heading), along_m(m, heading)
    known = np.isfinite(across) & np.isfinite(turn) & (np.abs(turn) < MOST_TURN_RAD)
    across, along, turn = across[known], along[known], turn[known]
    return _proportion(across, turn - _proportion(turn, along) * along)


def _proportion(values: FloatArray, of: FloatArray) -> float:
    """Least squares; 0 of nothing."""
    return float(of @ values) / max(float(of @ of), 1e-12)


def offset_beside_arm_rad(evidence: Evidence, heading: Heading) -> float | None:
    """Course less yaw, beside what an arm moves aside in turns; None where turns are all alike."""
    m = evidence.motion
    turn = evidence.turn_rad(m)
    across = np.where(np.abs(turn) < MOST_TURN_RAD, across_m(m, heading), np.nan)
    found = relation(across, along_m(m, heading), turn)
    if found is None or not found.distinct or found.slope_sigma > SURELY_RAD:
        return None
    return heading.offset_rad + float(np.arctan(found.slope))


def parts_apart(evidence: Evidence, heading: Heading) -> str:
    """By what the offset differs between parts: of the time, of the place, slow and fast."""
    m, pose = evidence.motion, evidence.run.pose
    far = far_and_straight(m, evidence.turn_rad(m))
    if far is None or pose is None:
        return ""
    off = np.exp(2j * (m.course_rad - middle_yaw(m, heading) - heading.offset_rad))[far]
    x, y = (np.interp(m.start_s[far], pose.stamps_s, pose[name]) for name in ("x", "y"))
    for words, values, count in (
        ("in quarters of the recording", m.start_s[far], 4),
        ("in two halves of the place", x, 2),
        ("in two halves of the place", y, 2),
        ("when slow and when fast", (m.distance_m / m.lasts_s)[far], 2),
    ):
        parts = np.array_split(np.argsort(values), count)
        offsets = np.angle([off[rows].mean() for rows in parts]) / 2
        if np.ptp(offsets) > min(HOLDS * abs(heading.offset_rad), MOST_APART_RAD):
            return f"offsets differ by {np.degrees(np.ptp(offsets)):.0f} degrees {words}"
    return ""


def course_apart(evidence: Evidence) -> str:
    """A course that does not go with yaw, though distances go with the treads."""
    distance = evidence.distance_by_mean
    found = headings(evidence.motion, evidence.turn_rad(evidence.motion))
    if not evidence.yaw_measured or not found:
        return ""
    if max(found[name].concentration for name in ("radians", "radians, reversed")) > POOR:
        return ""
    if distance is None or distance.correlation < STEADY or distance.measured < LEAST_WINDOWS:
        return ""
    if max(_explained_along_yaw(evidence, heading) for heading in found.values()) > BY_YAW:
        return ""
    return (
        "the course of pose.csv does not keep to its yaw, though its distances are those of the "
        f"treads (correlation {distance.correlation:.2f})"
    )


def _explained_along_yaw(evidence: Evidence, heading: Heading) -> float:
    """Share of the measured motion that is a constant times the travel and the turn, as yaw turns.

    The constants are complex: an offset of yaw, and an arm, whose way in turns is its own.
    """
    m = evidence.motion
    turn = evidence.turn_rad(m)
    moved_m = (m.moved_m @ np.array([1, 1j])) * np.exp(-1j * middle_yaw(m, heading))
    known = np.isfinite(moved_m) & np.isfinite(turn)
    columns = np.column_stack([m.mean_m, turn])[known]
    fit, *_ = np.linalg.lstsq(columns.astype(complex), moved_m[known], rcond=None)
    left = np.sum(np.abs(moved_m[known] - columns @ fit) ** 2)
    return 1 - float(left / np.sum(np.abs(moved_m[known]) ** 2))
