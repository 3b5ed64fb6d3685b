"""Short parts between jumps, in which the poses move as no part of the recording elsewhere."""

from collections.abc import Sequence
from itertools import pairwise

import numpy as np

from odometry.arrays import BoolArray
from odometry.checks.evidence.evidence import Evidence
from odometry.checks.evidence.heading import middle_yaw
from odometry.checks.statistics.relation import Relation

LONGEST_S = 20.0
BESIDE_S = 1.0  # of a jump, that is left out
LEAST_WINDOWS = 5
HELD = 0.9  # correlation of the whole, from which a part is compared with it
# Of the squares of both motions, what they differ by: 1 where they are unrelated, and one less the
# correlation in the windows of the whole that are no outliers.
APART, TIMES = 0.1, 5.0


def strange_part(evidence: Evidence, cuts_s: Sequence[float]) -> str:
    """Words where poses between two jumps [s of run time] do not go with the other sensors.

    A reference that jumps measures the same robot before and after it, in another place and with
    another offset of its yaw.
    """
    for begin_s, end_s in pairwise(cuts_s):
        if end_s - begin_s > LONGEST_S:
            continue  # is compared by itself
        span_s = np.array([begin_s + BESIDE_S, end_s - BESIDE_S]) + evidence.run.began_s
        turns, ways = evidence.turn_motion, evidence.motion
        inside = [(of.start_s > span_s[0]) & (of.end_s < span_s[1]) for of in (turns, ways)]
        if _turns_apart(evidence, inside[0]) or _ways_apart(evidence, inside[1]):
            return (
                f"between {begin_s:.1f} and {end_s:.1f} s the poses do not move as treads and "
                "gyroscope say"
            )
    return ""


def _turns_apart(evidence: Evidence, inside: BoolArray) -> bool:
    """Whether turns (K,) in a part are not those of the gyroscope, else of the treads."""
    fit = evidence.pose_turn_by_gyroscope or evidence.pose_turn_by_difference
    if fit is None or fit.correlation < HELD:
        return False
    inside = inside & np.isfinite(fit.residuals)
    turned, left = evidence.pose_turn_rad[inside], fit.residuals[inside]
    both = float(np.sum(turned**2) + np.sum((turned - left) ** 2))
    return _much(fit, float(np.sum(left**2)), both, inside)


def _ways_apart(evidence: Evidence, inside: BoolArray) -> bool:
    """The same of the way (K,) along and across the yaw, with an offset of yaw of its own."""
    m, heading, fit = evidence.motion, evidence.heading, evidence.forward_by_mean
    if heading is None or fit is None or fit.correlation < HELD:
        return False
    way_m = m.distance_m * np.exp(1j * (m.course_rad - middle_yaw(m, heading)))
    inside = inside & np.isfinite(way_m)
    way_m, driven_m = way_m[inside], abs(fit.slope) * m.mean_m[inside]
    both = float(np.sum(np.abs(way_m) ** 2) + np.sum(driven_m**2))
    return _much(fit, both - 2 * float(np.abs(np.sum(way_m * driven_m))), both, inside)


def _much(of_whole: Relation, left: float, both: float, inside: BoolArray) -> bool:
    most = max(APART, TIMES * (1 - of_whole.correlation))
    return bool(inside.sum() >= LEAST_WINDOWS and left > most * both)
