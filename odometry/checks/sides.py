"""One tread that counts more than the other, an offset, and columns that hold other things."""

from collections.abc import Iterator

import numpy as np

from odometry.checks.evidence import Evidence
from odometry.checks.finding import Finding, Level
from odometry.checks.relation import Relation, relation

UNEQUAL = 1.5  # ratio of the two treads' shares; real recordings had up to 1.25 where terrain holds
LEAST_OFFSET_M_S = 0.03
TIMES = 8.0  # standard deviations
TWIST = 0.15  # share of the turn that may come from the other column


def sides(evidence: Evidence) -> Iterator[Finding]:
    """Compare what the left and the right tread add to the way along and to the turn."""
    turn = evidence.gyroscope_by_treads or evidence.pose_turn_by_treads
    forward = evidence.forward_by_treads
    twist = list(_twist(turn, forward))
    yield from twist
    if twist or turn is None or turn.explained < 0.8:
        return
    yield from _unequal(turn, forward)
    yield from _offset(evidence)


def _twist(turn: Relation | None, forward: Relation | None) -> Iterator[Finding]:
    """v_left holds the speed, v_right the turn rate, or the other way round."""
    if turn is None or turn.correlation < 0.9:
        return
    for speed, rate, names in ((0, 1, ("v_left", "v_right")), (1, 0, ("v_right", "v_left"))):
        of_speed, of_rate = turn.coefficients[speed], turn.coefficients[rate]
        if not abs(of_speed) < TWIST * abs(of_rate) or not 0.3 < abs(of_rate) < 1.5:
            continue
        if forward is not None and not _only(forward, speed, rate):
            continue
        yield Finding(
            "treads_are_twist",
            Level.WARNING,
            f"turns come from {names[1]} alone ({of_rate:.2f} rad for each unit of it, "
            f"{of_speed:.2f} for {names[0]})",
            f"The columns hold the twist: {names[0]} is the forward speed v and {names[1]} the turn "
            "rate omega, not the speeds of two treads; or the other tread's column repeats the mean",
            "Convert: v_left = v - omega * width / 2, v_right = v + omega * width / 2",
        )
        return


def _only(forward: Relation, speed: int, rate: int) -> bool:
    return abs(forward.coefficients[rate]) < 0.3 * abs(forward.coefficients[speed])


def _unequal(turn: Relation, forward: Relation | None) -> Iterator[Finding]:
    if not (turn.certain(0, TIMES) and turn.certain(1, TIMES)):
        return
    left, right = np.abs(turn.coefficients)
    ratio = float(left / right)
    if forward is not None and forward.certain(0, TIMES) and forward.certain(1, TIMES):
        other = float(abs(forward.coefficients[0] / forward.coefficients[1]))
        if not min(ratio, other) > 1.25 and not max(ratio, other) < 0.8:
            return
    if 1 / UNEQUAL < ratio < UNEQUAL:
        return
    side = "right" if ratio > 1 else "left"
    factor = max(ratio, 1 / ratio)
    yield Finding(
        "treads_unequal",
        Level.WARNING,
        f"a metre of the left tread turns the robot by {left:.3g} rad, one of the right by "
        f"{right:.3g} rad",
        f"One side has another scale: the {side} tread reads {factor:.3g} times too much against "
        "the other (unit, wheel radius, gear, ticks of one side)",
        "Compare both sides on a straight drive",
    )


def _offset(evidence: Evidence) -> Iterator[Finding]:
    """A constant added to one tread: it drives while the robot stands."""
    m = evidence.motion
    forward = relation(evidence.forward_m, m.left_m, m.right_m, m.lasts_s)
    if forward is None or not forward.certain(2, TIMES) or forward.explained < 0.8:
        return
    offset = float(forward.coefficients[2] / np.mean(np.abs(forward.coefficients[:2])))
    turn = relation(m.turn_rad, m.left_m, m.right_m, m.lasts_s)
    if abs(offset) < LEAST_OFFSET_M_S or turn is None or not turn.certain(2, TIMES):
        return
    width = float(np.mean(np.abs(turn.coefficients[:2])))
    of_turn = float(turn.coefficients[2] / width)
    if not 0.5 < abs(of_turn / offset) < 2.0:
        return
    side = "left" if np.sign(of_turn) == -np.sign(offset) else "right"
    yield Finding(
        "tread_offset",
        Level.WARNING,
        f"the robot moves {forward.coefficients[2]:+.3f} m/s and turns "
        f"{turn.coefficients[2]:+.3f} rad/s besides what the treads say",
        f"The {side} tread has an offset of {-offset:+.3f} m/s: it reads a constant too much",
        f"Subtract it from v_{side}: it should read 0 where the robot stands",
    )
