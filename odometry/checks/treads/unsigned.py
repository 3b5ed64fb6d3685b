"""Tread speeds without their sign: encoders of one channel, or a log of magnitudes."""

from collections.abc import Iterator

import numpy as np

from odometry.arrays import BoolArray
from odometry.checks.evidence.evidence import Evidence
from odometry.checks.evidence.motion import Motion
from odometry.checks.findings.finding import Finding, Level
from odometry.checks.treads.reversals import reversals
from odometry.checks.treads.treads import is_coarse

LEAST_WINDOWS = 6
LEAST_REVERSALS = 3
ORDINARY = (0.5, 1.5)  # metres moved for each of tread travel; else the unit is another one
MOVING = 0.1  # share of the fastest speed
EQUAL = 0.15  # difference of two sides, as a share of their sum, that turns a robot little
NARROWEST, WIDEST = 0.8, 4.0  # effective width in track widths
OF_ONE_WIDTH = 0.25  # difference of a spin from the usual one, which starts and stops leave
MOST = 0.6  # of the turns with equal speeds
HALF = 0.5  # of these windows, in which both columns are the same number
BACKWARD = 0.5  # of the way of the treads
# Of the windows backwards, where treads read nothing: these have lost more than a sign.
SILENT = 0.5
# Windows with equal speeds in which the robot turns, and those of its turns to one side: 1 and 1 of
# three dead zones of one tread; of 11 real drives of robots that also drive straight, made
# unsigned, one of both is 0.9 and less.
ALL = 0.95
COARSE_STEPS = "; or speeds come in steps so coarse that both read the same"
FORWARD_TOO = 0.1  # share of the windows; else the yaw is off by half a turn


def unsigned(evidence: Evidence) -> Iterator[Finding]:
    """Speeds that are never negative though the robot spins on the spot or drives backwards.

    Where both sides read about the same, the robot hardly turns: it turns as if one side
    ran backwards. Where both are positive, measured positions go backwards, or turn back at once.
    """
    metres = evidence.metres_per_metre
    other_unit = metres is not None and not ORDINARY[0] < metres < ORDINARY[1]
    if (evidence.speeds_m_s < 0).any() or other_unit:
        return
    (spins, same, always), backwards = _spins(evidence), _backwards(evidence)
    seen = []
    if spins >= LEAST_WINDOWS:
        seen.append(f"the robot turns on the spot in {spins} windows with equal speeds")
    if backwards >= LEAST_WINDOWS:
        seen.append(f"positions go backwards in {backwards} windows")
    turned_back = 0 if seen else reversals(evidence)
    if turned_back >= LEAST_REVERSALS:
        seen.append(f"positions turn back {turned_back} times faster than the treads can turn it")
    either, others = "Tread", ""
    if same > HALF * spins:
        either = "Either tread"
        others = (
            "; or both columns hold one speed there (the mean of the treads, or one of them twice):"
            f" they are the same number in each row of {same} of these windows"
            + COARSE_STEPS
            * is_coarse(evidence)
        )
    elif always and not backwards:
        either = "Either tread"
        others = (
            "; or one tread reads too little (a dead zone: its slow speeds read zero, others too "
            "little by as much): the robot turns to one side wherever both columns are about equal"
        )
    if seen:
        yield Finding(
            "treads_unsigned",
            Level.WARNING,
            f"no tread speed is negative, and {', and '.join(seen)}",
            f"{either} speeds have lost their sign: encoders of one channel, or magnitudes in the "
            f"log{others}",
            "Log the direction of each tread; where it cannot be had, take the sign of the command",
        )


def _spins(evidence: Evidence) -> tuple[int, int, bool]:
    """Windows of turns that one side alone, running backwards, explains, and equal ones of them.

    Equal are both treads, the same number in each row. And whether the robot turns to one side
    wherever speeds are equal: then no straight drive shows that both treads read alike.
    With equal speeds the robot either drives straight or spins as if of one width: turns of any
    size in between are another fault.
    """
    turns, of = evidence.uniform.gyroscope_rad, evidence.uniform
    if evidence.yaw_rate is None:
        turns, of = evidence.pose_turn_rad, evidence.turn_motion
    both_m = of.left_m + of.right_m
    equal = _moves(evidence, of) & (np.abs(of.difference_m) < EQUAL * both_m)
    over_width = np.abs(turns) * evidence.run.robot.track_width / np.maximum(both_m, 1e-9)
    turning = equal & (over_width > EQUAL / 2)
    if not turning.any():
        return 0, 0, False
    usual = float(np.median(over_width[turning]))
    spun = turning & (np.abs(over_width / usual - 1) < OF_ONE_WIDTH)
    one_width = 1 / WIDEST < usual < 1 / NARROWEST and spun.sum() > MOST * turning.sum()
    if not one_width:
        return 0, 0, False
    to_left = float(np.mean(turns[turning] > 0))
    always = turning.sum() > ALL * equal.sum() and max(to_left, 1 - to_left) > ALL
    return int(spun.sum()), int((spun & _same(evidence, of)).sum()), bool(always)


def _same(evidence: Evidence, motion: Motion) -> BoolArray:
    """Windows (K,) in each row of which both treads are the same number: two encoders differ."""
    left, right = evidence.run.odometry.stack("v_left", "v_right").T
    differ = np.cumsum(np.insert(left != right, 0, 0))
    first, last = (np.searchsorted(evidence.stamps_s, s) for s in (motion.start_s, motion.end_s))
    return np.asarray((last > first) & (differ[last] == differ[first]))


def _backwards(evidence: Evidence) -> int:
    m = evidence.motion
    forward_m = evidence.forward_m
    moving = _moves(evidence, m) & np.isfinite(forward_m)
    ahead = moving & (forward_m > BACKWARD * m.mean_m)
    behind = moving & (forward_m < -BACKWARD * m.mean_m)
    enough = ahead.sum() > FORWARD_TOO * moving.sum()
    silent = (m.mean_m < MOVING * evidence.fastest_m_s * m.lasts_s) & np.isfinite(forward_m)
    silent &= forward_m < -MOVING * evidence.fastest_m_s * m.lasts_s
    return int(behind.sum()) if enough and silent.sum() < SILENT * behind.sum() else 0


def _moves(evidence: Evidence, motion: Motion) -> BoolArray:
    return np.asarray(motion.mean_m > MOVING * evidence.fastest_m_s * motion.lasts_s)
