"""How turns of each sensor come from the two treads: with which sign, or not at all."""

from enum import Enum

import numpy as np

from odometry.arrays import FloatArray
from odometry.checks.evidence.evidence import CLEARLY, Evidence
from odometry.checks.evidence.once import once
from odometry.checks.statistics.relation import Relation

LEAST_TURN_RAD = 1.0  # summed turns below which nothing is said
UNRELATED = (
    0.2  # share of the turns explained below which two sensors do not measure the same turns
)

HELD = 0.9  # share of the turns explained from which less is compared with less
TIMES_MORE = 3.0
WIDE = 3.0  # track widths as which a robot turns at most, but for snow


class Sense(Enum):
    """How turns of a sensor come from the two treads."""

    AGREES = "agrees"
    OPPOSITE = "opposite"
    LEFT_REVERSED = "left tread reversed"
    RIGHT_REVERSED = "right tread reversed"
    UNRELATED = "unrelated"
    UNKNOWN = "unknown"


SIGNS = {
    (-1, 1): Sense.AGREES,
    (1, -1): Sense.OPPOSITE,
    (1, 1): Sense.LEFT_REVERSED,
    (-1, -1): Sense.RIGHT_REVERSED,
}


def sense(
    by_treads: Relation | None,
    by_difference: Relation | None,
    turned_rad: float,
    lasting_rad: float,
) -> Sense:
    """Read the signs of `turn = a left + b right`; uncertain ones are no evidence."""
    if by_treads is None or not turned_rad > LEAST_TURN_RAD:
        return Sense.UNKNOWN
    kept = by_treads.kept.sum() / by_treads.measured
    if by_treads.explained < UNRELATED and (by_treads.correlation < 0.5 or kept < 0.5):
        return Sense.UNRELATED if lasting_rad > LEAST_TURN_RAD else Sense.UNKNOWN
    if by_treads.certain(0) and by_treads.certain(1):
        left, right = np.sign(by_treads.coefficients).astype(int)
        shares = np.abs(by_treads.coefficients)
        alone = by_difference is None or _explains_more(by_treads, by_difference)
        if shares.min() > 0.2 * shares.max() and (left != right or alone):
            return SIGNS[int(left), int(right)]
    if by_difference is None or (by_treads.distinct and _explains_more(by_treads, by_difference)):
        return Sense.UNKNOWN
    if by_difference.certain() and by_difference.correlation > 0.5:
        return Sense.AGREES if by_difference.slope > 0 else Sense.OPPOSITE
    return Sense.UNKNOWN


def _explains_more(by_treads: Relation, by_difference: Relation) -> bool:
    left, left_by_difference = 1 - by_treads.explained, 1 - by_difference.explained
    tight = by_treads.explained > HELD and left_by_difference > TIMES_MORE * left
    return tight or left_by_difference - left > CLEARLY


def lasting_turn_rad(turns: FloatArray, lasts_s: FloatArray) -> float:
    """Range of the heading that turns (K,) add up to, less a constant rate: no noise, no bias."""
    known = np.isfinite(turns)
    if known.sum() < 2:
        return 0.0
    heading, at_s = np.cumsum(turns[known]), np.cumsum(lasts_s[known])
    return float(np.ptp(heading - np.polyval(np.polyfit(at_s, heading, 1), at_s)))


def _lasting_by_treads_rad(evidence: Evidence) -> float:
    m, width_m = evidence.uniform, WIDE * evidence.run.robot.track_width
    return lasting_turn_rad(m.difference_m / width_m, m.lasts_s)


@once
def gyroscope_sense(evidence: Evidence) -> Sense:
    """How the gyroscope's turns come from the treads."""
    m = evidence.uniform
    turned = float(np.nansum(np.abs(m.gyroscope_rad)))
    lasting = max(lasting_turn_rad(m.gyroscope_rad, m.lasts_s), _lasting_by_treads_rad(evidence))
    return sense(evidence.gyroscope_by_treads, evidence.gyroscope_by_difference, turned, lasting)


@once
def pose_sense(evidence: Evidence) -> Sense:
    """How measured turns come from the treads."""
    m, turns = evidence.turn_motion, evidence.pose_turn_rad
    turned = float(np.nansum(np.abs(turns)))
    lasting = max(lasting_turn_rad(turns, m.lasts_s), _lasting_by_treads_rad(evidence))
    return sense(evidence.pose_turn_by_treads, evidence.pose_turn_by_difference, turned, lasting)
