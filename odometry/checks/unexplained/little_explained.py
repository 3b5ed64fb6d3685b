"""Measured motion that treads or gyroscope explain less than in any recording of a robot."""

from collections.abc import Iterator

import numpy as np

from odometry.arrays import FloatArray
from odometry.checks.evidence.evidence import Evidence
from odometry.checks.evidence.motion import Motion
from odometry.checks.evidence.scatter import noise_of_ends
from odometry.checks.statistics.relation import Relation
from odometry.checks.turns.turn_signs import lasting_turn_rad

# Shares of the squares that are explained at least, in the nine tenths of the windows that are
# explained best. Least of 14 and of 12 real recordings, ice and sand among them: 0.90 and 0.93 of
# the way, 0.84 and 0.83 of turns by treads, 0.93 and 0.96 by the gyroscope.
WAY, TURNS_BY_TREADS, TURNS_BY_GYROSCOPE, ORDINARY = 0.82, 0.75, 0.87, 0.9
MOST_NOISE = 0.07  # of a window, m or rad
OF_NOISE = 0.56  # of its variance that is left in that share of windows, of a normal distribution
# Share of the sharp turns against the treads, by each sensor: at most 0.06, on ice.
AGAINST, SHARP = 0.08, 0.3
# Range of the heading by treads without slip, and its ratio to that of the gyroscope; on snow 9.
LEAST_BY_TREADS_RAD, TIMES_SLIP = 2.0, 20.0
LEAST_WINDOWS = 15
TURNING = 0.3  # of the mean of both treads, by which they differ in a turn
LEAST_TURN_RAD = 1.0  # range of the heading
LEAST_TRAVEL_M = 2.0


def little_explained(evidence: Evidence) -> Iterator[str]:
    """Words where treads or gyroscope explain too little of what the poses measure."""
    way = evidence.forward_by_treads
    if way is not None and evidence.run.wheel_travel_m[-1] > LEAST_TRAVEL_M:
        yield from _words(
            way, evidence.motion, evidence.forward_m, WAY, ("the treads explain", "way")
        )
    if evidence.yaw_rate is not None:
        yield from _no_turns(evidence)
    m = evidence.turn_motion
    if not evidence.yaw_measured:
        return
    if lasting_turn_rad(evidence.turn_rad(m), m.lasts_s) < LEAST_TURN_RAD:
        return
    turns = evidence.pose_turn_rad
    by_treads, by_gyroscope = evidence.pose_turn_by_treads, evidence.pose_turn_by_gyroscope
    yield from _words(by_treads, m, turns, TURNS_BY_TREADS, ("the treads explain", "turns"))
    yield from _words(
        by_gyroscope, m, turns, TURNS_BY_GYROSCOPE, ("the gyroscope explains", "turns")
    )
    of = evidence.uniform
    against = [_against(turns, m)]
    if evidence.yaw_rate is not None:
        against.append(_against(of.gyroscope_rad, of))
    if min(against) > AGAINST:
        yield f"{100 * min(against):.0f} % of the sharp turns are against those of the treads"


def _no_turns(evidence: Evidence) -> Iterator[str]:
    m = evidence.uniform
    width_m = evidence.run.robot.track_width
    turned = lasting_turn_rad(m.gyroscope_rad, m.lasts_s)
    by_treads = lasting_turn_rad(m.difference_m / width_m, m.lasts_s)
    if by_treads > max(LEAST_BY_TREADS_RAD, TIMES_SLIP * turned):
        yield (
            f"the gyroscope turns over a range of {turned:.2g} rad, the treads over "
            f"{by_treads:.2g} rad of a robot without slip"
        )


def _against(turns: FloatArray, motion: Motion) -> float:
    """Share of the turns (K,), sharp by both sensors, that are of the rarer sign of the two.

    By the treads they are beyond what scales that differ a little make of a straight line.
    """
    others = motion.difference_m
    known = np.isfinite(turns) & np.isfinite(others)
    if not known.any():
        return 0.0
    sharp = known & (np.abs(others) > TURNING * np.abs(motion.mean_m))
    for values in (turns, others):
        sharp &= np.abs(values) > SHARP * np.quantile(np.abs(values[known]), 0.95)
    share = float(np.mean(turns[sharp] * others[sharp] < 0)) if sharp.any() else 0.0
    return min(share, 1 - share) if sharp.sum() >= LEAST_WINDOWS else 0.0


def _words(
    found: Relation | None, m: Motion, target: FloatArray, least: float, words: tuple[str, str]
) -> Iterator[str]:
    """Beside the noise of the poses: on slow robots it is most of what is left."""
    if found is None or found.measured < LEAST_WINDOWS:
        return
    known = np.isfinite(found.residuals)
    squares = np.sort(found.residuals[known] ** 2)
    noise = noise_of_ends(m, found)
    noise *= noise < MOST_NOISE  # more is no noise: rows that are mixed look so, too
    left = float(np.sum(squares[: int(ORDINARY * len(squares))]))
    left -= OF_NOISE * len(squares) * noise**2
    explained = 1 - max(left, 0.0) / float(np.sum(target[known] ** 2))
    if explained < least:
        yield f"{words[0]} {100 * max(explained, 0.0):.0f} % of the measured {words[1]}"
