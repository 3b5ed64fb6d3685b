"""Turns, or a yaw, that have little to do with what the other sensors measure."""

from collections.abc import Iterator

import numpy as np

from odometry.arrays import FloatArray
from odometry.checks.evidence.evidence import Evidence
from odometry.checks.findings.finding import Finding, Level, disagreement
from odometry.checks.statistics.relation import Relation, relation
from odometry.checks.turns.turn_signs import Sense, gyroscope_sense, pose_sense
from odometry.checks.turns.turns_in_parts import turns_flip
from odometry.checks.unexplained.beyond_slip import beyond_slip

POOR = 0.6  # correlation below which sensors do not measure the same motion
LEAST_WINDOWS = 15
OR_TREADS = "; or the columns of the treads are at fault"  # where nothing else goes with them
SHARP, ALIKE = 0.3, 0.3  # of the sharpest turns, and of those to the other side


def agreement(evidence: Evidence) -> Iterator[Finding]:
    """Turns of treads, gyroscope and poses that have little to do with each other."""
    gyroscope, pose = gyroscope_sense(evidence), pose_sense(evidence)
    by_gyroscope = evidence.pose_turn_by_gyroscope
    together = by_gyroscope is not None and by_gyroscope.explained > POOR
    unrelated = Sense.UNRELATED
    if _is_magnitude(evidence):
        swapped = "; or left and right treads are exchanged for a part of the recording"
        yield _finding(
            "gyroscope_unrelated",
            "gyro_z is never negative, though the "
            f"{'poses' if evidence.yaw_measured else 'treads'} turn to both sides",
            "gyro_z holds the size of the turn rate: its sign was lost"
            + ("" if evidence.yaw_measured else swapped),
            "Log the yaw rate with its sign",
        )
    elif unrelated in (pose, gyroscope) and (flips := turns_flip(evidence)):
        yield disagreement(flips)
    elif pose is unrelated and by_gyroscope and together:
        slips = "" if beyond_slip(evidence) else ", or the treads slip all the time"
        yield _finding(
            "treads_unrelated",
            f"turns by gyroscope and poses agree (correlation {by_gyroscope.correlation:.2f}), the "
            "treads' do not",
            "The cause cannot be determined: odometry.csv is of another recording or another "
            "clock, its columns are exchanged (v_left and v_right may hold speed and turn rate) or "
            f"hold no tread speeds (numbers that wrapped, a rate of them){slips}",
            "Plot the three yaw rates: check --picture",
        )
    elif pose is unrelated and _moves(evidence.pose_turn_by_treads):
        yield _finding(
            "poses_unrelated",
            f"turns of pose.csv have nothing to do with those of the treads (correlation "
            f"{evidence.pose_turn_by_treads.correlation:.2f})"
            if evidence.pose_turn_by_treads
            else "",
            "pose.csv or odometry.csv is of another recording or another clock, its rows are out "
            "of order or were lost, or yaw is no heading (the course over ground, a component of a "
            f"quaternion, another axis, noise){'' if gyroscope is Sense.AGREES else OR_TREADS}",
            "Plot the three yaw rates: check --picture",
        )
    elif gyroscope is unrelated and _moves(evidence.gyroscope_by_treads) and not together:
        agreed = pose in (Sense.AGREES, Sense.OPPOSITE)
        yield _finding(
            "gyroscope_unrelated",
            "gyro_z has little to do with the turns of "
            + ("treads and poses" if agreed else "the treads"),
            f"{'' if agreed else 'Either '}gyro_z is of another axis (z is not up), another "
            "recording or another clock, its rows or those of the treads were lost and stamps made "
            "up, or it holds no turn rate (a magnitude, its change, a component along a fixed "
            "direction)" + ("" if agreed else f"{OR_TREADS}, or slip all the time"),
            "State the axes of the sensor in [sensors] imu; check --picture shows the yaw rates",
        )


def _is_magnitude(evidence: Evidence) -> bool:
    """Whether a yaw rate is never negative, and as large in turns to one side as to the other."""
    m = evidence.motion if evidence.yaw_measured else evidence.uniform
    others = evidence.pose_turn_rad if evidence.yaw_measured else m.difference_m
    known = np.isfinite(others) & np.isfinite(m.gyroscope_rad)
    if evidence.yaw_rate is None or evidence.yaw_rate[1].min() < 0 or not known.any():
        return False
    turns, others = m.gyroscope_rad[known], others[known]
    sharp = SHARP * np.quantile(np.abs(others), 0.95)
    sides = [turns[side * others > sharp] for side in (-1, 1)]
    if min(map(len, sides)) < LEAST_WINDOWS:
        return False
    middles = sorted(float(np.median(side)) for side in sides)
    if middles[0] <= ALIKE * middles[1]:
        return False
    return not _is_signed_beside_a_bias(turns, others, m.lasts_s[known])


def _is_signed_beside_a_bias(turns: FloatArray, others: FloatArray, lasts_s: FloatArray) -> bool:
    """Whether turns (K,) go with others better than with their size: slow ones beside a bias."""
    signed, size = (relation(turns, of, lasts_s) for of in (others, np.abs(others)))
    if signed is None or not (signed.certain(0, 3.0) and signed.slope > 0):
        return False
    return size is None or signed.explained > size.explained


def _moves(found: Relation | None) -> bool:
    return found is not None and found.measured >= LEAST_WINDOWS


def yaw_against_course(evidence: Evidence) -> Iterator[Finding]:
    """Yaw that fits neither the course nor the course reversed, though positions are good."""
    if evidence.heading is not None or not evidence.yaw_measured:
        return
    distance = evidence.distance_by_mean
    if distance is None or distance.correlation < 0.9 or distance.measured < 3 * LEAST_WINDOWS:
        return
    if pose_sense(evidence) is not Sense.UNRELATED:
        return
    if evidence.best_concentration is None or evidence.best_concentration > POOR:
        return
    yield _finding(
        "yaw_unrelated",
        "distances of pose.csv agree with the treads (correlation "
        f"{distance.correlation:.2f}), but yaw points nowhere near the course (concentration "
        f"{evidence.best_concentration:.2f})",
        "The column yaw holds something else than the heading, all along or in a part (a component "
        "of a quaternion, another axis, another unit, a bearing, an angle without its sign)",
        "Leave yaw empty, or convert it",
    )


def _finding(name: str, seen: str, cause: str, remedy: str) -> Finding:
    return Finding(name, Level.WARNING, seen, cause, remedy)
