"""One tread that is read for both sides: later, rounded, or of another scale."""

from collections.abc import Iterator

import numpy as np

from odometry.checks.copies.repetition import Repetition, repetition
from odometry.checks.evidence.evidence import Evidence
from odometry.checks.findings.finding import Finding, Level
from odometry.checks.statistics.relation import relation
from odometry.checks.treads.treads import EQUAL
from odometry.checks.turns.turn_signs import lasting_turn_rad

# Shares of the squares explained, of the second differences and of the values: at most 0.79 and
# 0.97 in 74 real recordings.
CHANGES, VALUES = 0.9, 0.999
LEAST_TURN_RAD = 1.0  # range of the heading
BY_EACH = 0.7  # share of the turns by both treads, from which these are two
BY_MEAN = 0.9  # share of the turns by the mean speed, from which it may be one circle


def one_encoder(evidence: Evidence) -> Iterator[Finding]:
    """A robot that turns both ways while one tread repeats the other from row to row.

    Of treads that are equal to the last digit `equal_treads` says the same.
    """
    left, right = evidence.speeds_m_s.T
    if np.mean(left == right) > EQUAL:
        return
    for name, of, values, source in (
        ("v_left", "v_right", left, right),
        ("v_right", "v_left", right, left),
    ):
        found = repetition(evidence.stamps_s, values, evidence.stamps_s, source[:, None])
        turned = _turned(evidence) if found is not None and _is_exact(found) else None
        if found is None or turned is None:
            continue
        later = (
            f", {found.delay_s:+.2g} s later" if abs(found.delay_s) > evidence.period_s / 2 else ""
        )
        yield Finding(
            "treads_equal",
            Level.WARNING,
            f"{name} is {found.coefficients[0]:.4g} times {of}{later} "
            f"({100 * found.of_changes:.2f} % of its changes from row to row), and {turned[0]} "
            f"turns over a range of {turned[1]:.2g} rad",
            "Both columns hold one speed: one encoder is read for both sides, or one column was "
            "computed from the other",
            "Log the speed of each tread; the turns are lost",
        )
        return


def _is_exact(found: Repetition) -> bool:
    return found.of_changes > CHANGES and found.of_values > VALUES


def _turned(evidence: Evidence) -> tuple[str, float] | None:
    """Which sensor turned, and over what range [rad].

    Where no steady circle explains it, and not the little by which treads differ on a straight
    drive.
    """
    for name, turns, motion in (
        ("the gyroscope", evidence.uniform.gyroscope_rad, evidence.uniform),
        ("the poses", evidence.pose_turn_rad, evidence.turn_motion),
    ):
        turned_rad = lasting_turn_rad(turns, motion.lasts_s)
        circle = relation(turns, motion.mean_m, motion.lasts_s)
        each = relation(turns, motion.left_m, motion.right_m, motion.lasts_s)
        if turned_rad < LEAST_TURN_RAD or circle is None or circle.explained > BY_MEAN:
            continue
        if each is None or each.explained < BY_EACH:
            return name, turned_rad
    return None
