"""A tread that counts more than the other, an offset, other columns."""

from collections.abc import Iterator

import numpy as np

from odometry.checks.evidence.evidence import Evidence
from odometry.checks.evidence.motion import turns_both_ways
from odometry.checks.findings.finding import Finding, Level, disagreement
from odometry.checks.findings.undo import Mend, changed, treads_times
from odometry.checks.statistics.relation import Relation, pieces, relation
from odometry.checks.treads.one_motion import motion_alone
from odometry.checks.treads.side_changes import constant_as_well, side_changes
from odometry.checks.treads.straight_drives import straight_drives
from odometry.checks.turns.constancy import (
    HELD,
    UNEQUAL,
    groups_of_motion,
    ratio_of_sides,
    turns_of_each,
)

LEAST_OFFSET_M_S = 0.03
TIMES = 5.0  # standard deviations
LEFT = 0.6  # share of the squares of what treads do not explain that an offset leaves at most
ARM = 0.5  # of the way along: more than an arm of the sensor adds to one tread
LASTING = 0.4  # share of the logarithm of a ratio that each piece of the recording has
TOO_LITTLE = 1.1  # metres moved for each of the mean tread travel, which no slip makes
AS_WELL = 1.15  # times what an offset leaves of the turns: the other one explains them as well
# Share of the turn that may come from the other column, without and with a measured way that comes
# from it alone: 0.22 of a robot that pulls to one side.
TWIST, TWIST_BY_WAY = 0.15, 0.3

MIXED = (
    "; or one column holds a part of the other tread (cross-talk), or what measures the turns has "
    "a part of the speed: without a measured way along these cannot be distinguished"
)


def sides(evidence: Evidence) -> Iterator[Finding]:
    """Compare what the left and the right tread add to the way along and to the turn."""
    turn = evidence.gyroscope_by_treads or evidence.pose_turn_by_treads
    forward = evidence.forward_by_treads
    twist = list(_twist(turn, forward)) if motion_alone(evidence) is None else []
    yield from twist
    if twist or turn is None:
        return
    found = list(_offset(evidence)) or list(_unequal(evidence, forward))
    yield from found or straight_drives(evidence)


def _twist(turn: Relation | None, forward: Relation | None) -> Iterator[Finding]:
    """v_left holds the speed, v_right the turn rate, or the other way round."""
    if turn is None or not turn.distinct or turn.correlation < 0.9:
        return
    most = TWIST if forward is None else TWIST_BY_WAY
    for speed, rate, names in ((0, 1, ("v_left", "v_right")), (1, 0, ("v_right", "v_left"))):
        of_speed, of_rate = turn.coefficients[speed], turn.coefficients[rate]
        at_most = abs(of_speed) + 2 * turn.sigmas[speed]  # a tread that hardly moves says nothing
        if not at_most < most * abs(of_rate) or not 0.3 < abs(of_rate) < 1.5:
            continue
        if forward is not None and not _only(forward, speed, rate):
            continue
        either, others = "The", "; or one tread's column repeats the mean"
        if forward is None:
            either = "Either the"
            others = (
                f"; or {names[0]} does not read its tread (its encoder was lost, its slow speeds "
                "read zero, it repeats the mean): no way along was measured to distinguish these"
            )
        yield Finding(
            "treads_are_twist",
            Level.WARNING,
            f"turns come from {names[1]} alone ({of_rate:.2f} rad for each unit of it, "
            f"{of_speed:.2f} for {names[0]})",
            f"{either} columns hold the twist: {names[0]} is the forward speed v, {names[1]} the "
            f"turn rate omega, not the speeds of two treads{others}",
            "Convert: v_left = v - omega * width / 2, v_right = v + omega * width / 2",
        )
        return


def _only(forward: Relation, speed: int, rate: int) -> bool:
    return bool(abs(forward.coefficients[rate]) < 0.3 * abs(forward.coefficients[speed]))


def _unequal(evidence: Evidence, forward: Relation | None) -> Iterator[Finding]:
    fits = turns_of_each(evidence)
    if not fits or any(fit.explained < HELD for fit in fits):
        return
    if not all(fit.certain(0, TIMES) and fit.certain(1, TIMES) for fit in fits):
        return
    left, right = np.abs(fits[0].coefficients)
    ratio = ratio_of_sides(fits)
    if 1 / UNEQUAL < ratio < UNEQUAL or not all(_surely(fit) for fit in fits):
        return
    if forward is not None and forward.certain(0, TIMES) and forward.certain(1, TIMES):
        other = float(abs(forward.coefficients[0] / forward.coefficients[1]))
        if (other - 1) * (ratio - 1) < 0:
            return
    along = forward.coefficients if forward is not None and forward.distinct else None
    if along is not None and abs(along[0] / along.sum() - ratio / (1 + ratio)) > ARM:
        yield disagreement(
            f"a metre of the left tread turns the robot {ratio:.3g} times as much as one of the "
            f"right, and has {100 * along[0] / along.sum():.0f} % of the way along"
        )
        return
    if but := side_changes(evidence) or constant_as_well(evidence) or _varies(evidence, ratio):
        yield disagreement(
            f"a metre of the left tread turns the robot {ratio:.3g} times as much as one of the "
            f"right, but {but}"
        )
        return
    sure = forward is not None and forward.certain(0, TIMES) and forward.certain(1, TIMES)
    begins, mixed = ("One", "") if sure else ("Either one", MIXED)
    side = "right" if ratio > 1 else "left"
    yield Finding(
        "treads_unequal",
        Level.WARNING,
        f"a metre of the left tread turns the robot by {left:.3g} rad, one of the right by "
        f"{right:.3g} rad",
        f"{begins} side has another scale: the {side} tread reads {max(ratio, 1 / ratio):.3g} "
        "times too much against the other (unit, wheel radius, gear, ticks of one side, a flat "
        f"tyre){mixed}",
        "Compare both sides on a straight drive",
        mend=_as_the_other(evidence, ratio),
    )


def _as_the_other(evidence: Evidence, ratio: float) -> Mend:
    """The side that reads too much made smaller, unless the way says that one reads too little."""
    if (evidence.metres_per_metre or 1.0) > TOO_LITTLE:
        return treads_times(max(ratio, 1.0), max(1 / ratio, 1.0))
    return treads_times(min(ratio, 1.0), min(1 / ratio, 1.0))


def _varies(evidence: Evidence, ratio: float) -> str:
    """Words where a part of the recording with enough motion has not the ratio of the whole.

    Parts are of time, of slow and fast motion, forwards and backwards, left and right turns.
    """
    m, turns = evidence.uniform, evidence.uniform.gyroscope_rad
    if evidence.gyroscope_by_treads is None:
        m, turns = evidence.turn_motion, evidence.pose_turn_rad
    parts = (np.where(rows, turns, np.nan) for _, *both in groups_of_motion(m) for rows in both)
    fits = [relation(of_part, m.left_m, m.right_m, m.lasts_s) for of_part in parts]
    found = [*pieces(turns, m.left_m, m.right_m), *filter(None, fits)]
    logarithms = [_log_ratio(part) for part in found if part.certain(0, TIMES)]
    size = abs(np.log(ratio))
    sure = (of for of, sigma in logarithms if sigma < LASTING * size)
    if all(of / np.log(ratio) > LASTING for of in sure):
        return ""
    return "not all the time, or not at each speed and in each direction"


def _surely(turn: Relation) -> bool:
    """Whether the shares of both treads surely differ."""
    log_ratio, sigma = _log_ratio(turn)
    return abs(log_ratio) > TIMES * sigma


def _log_ratio(turn: Relation) -> tuple[float, float]:
    """Logarithm of the left tread's share over the right one's, and its standard deviation."""
    left, right = turn.coefficients[:2]
    sigma = np.hypot(*(turn.sigmas[:2] / turn.coefficients[:2]))
    return float(np.log(abs(left / right))), float(sigma)


def _offset(evidence: Evidence) -> Iterator[Finding]:
    """A constant added to one tread: it reads a speed while the robot is stationary."""
    m = evidence.motion
    if _reads_zero(evidence) or not evidence.yaw_measured or not turns_both_ways(m):
        return
    turn = relation(evidence.pose_turn_rad, m.left_m, m.right_m, m.lasts_s)
    plain = relation(evidence.pose_turn_rad, m.left_m, m.right_m)
    if turn is None or not turn.certain(2, TIMES) or turn.explained < HELD:
        return
    little = plain is not None and 1 - turn.explained > LEFT * (1 - plain.explained)
    offset = float(turn.coefficients[2] / np.mean(np.abs(turn.coefficients[:2])))
    if little or abs(offset) < LEAST_OFFSET_M_S:
        return  # or it explains little of what the treads do not
    forward = relation(evidence.forward_m, m.left_m, m.right_m, m.lasts_s)
    if forward is None or not forward.certain(2, 3.0):
        return  # a turn alone may as well be slip that differs from side to side
    along = float(forward.coefficients[2])
    if not 0.5 < abs(along / (forward.coefficients[:2].mean() * offset)) < 2.0:
        return
    left = (along < 0) == (offset > 0)
    if but := side_changes(evidence) or _a_part_of_the_other(evidence, turn, left):
        yield disagreement(but)
        return
    reads = offset if left else -offset
    besides = "much at times (peaks that are held)"
    if reads * np.sign(np.sum(m.mean_m)) < 0:
        besides = "little at each speed (a dead zone: slow ones read zero)"
    tread = f"The {'left' if left else 'right'} tread has"
    yield Finding(
        "tread_offset",
        Level.WARNING,
        f"the robot turns {turn.coefficients[2]:+.3f} rad/s and moves {along:+.3f} m/s besides "
        "what the treads say",
        f"{tread} an offset of about {abs(offset):.3f} m/s: it reads a constant besides its speed, "
        f"a zero that was never set; or it reads too {besides}",
        "Look what it reads while the robot is stationary: an offset stays, and can be subtracted",
        mend=changed("odometry", "v_left" if left else "v_right", lambda speed: speed - reads),
    )


def _a_part_of_the_other(evidence: Evidence, offset: Relation, left: bool) -> str:
    """Words where the size of the other tread, in place of a constant, explains turns as well."""
    m = evidence.motion
    size_m = np.abs(m.right_m if left else m.left_m)
    rival = relation(evidence.pose_turn_rad, m.left_m, m.right_m, size_m)
    if rival is None or 1 - rival.explained > AS_WELL * (1 - offset.explained):
        return ""
    side, other = ("left", "right") if left else ("right", "left")
    return (
        f"the {side} tread reads a constant besides its speed, or a part of the size of that of "
        f"the {other} tread: both explain the turns alike"
    )


def _reads_zero(evidence: Evidence) -> bool:
    """Whether both treads read exactly zero at times: then neither has an offset."""
    still = (evidence.speeds_m_s == 0).all(axis=1)
    return bool(still.sum() * evidence.period_s > 1.0)
