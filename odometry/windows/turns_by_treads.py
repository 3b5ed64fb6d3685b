"""Turns between poses by the treads, over an effective width that the poses tell."""

import numpy as np

from odometry.arrays import FloatArray
from odometry.windows.close_pairs import LEAST_PAIRS, POSE_RAD, ClosePairs
from odometry.windows.robust import slope
from odometry.windows.tread_travel import TreadTravel

QUANTILE, MARGIN = 0.95, 2.0  # of the errors of close pairs, to what they may be elsewhere
LEAST_SHARE = 0.1  # of all that the treads travel by the width: what may be off


def turn_per_metre(travel: TreadTravel, pairs: ClosePairs) -> float | None:
    """Turn [rad] by a metre of tread difference; None where the pairs turned too little."""
    difference_m = travel.between(pairs.begin_s, pairs.end_s)[1]
    if not pairs.tell_a_scale or np.count_nonzero(difference_m) < LEAST_PAIRS:
        return None
    return slope(pairs.turned_rad, difference_m)


def turns_by_treads(
    travel: TreadTravel, pairs: ClosePairs, stamps_s: FloatArray, rad_per_m: float
) -> tuple[FloatArray, FloatArray]:
    """Turns (M - 1,) between stamps (M,), and how far each may be off."""
    _, difference_m, _, gross_m = travel.between(pairs.begin_s, pairs.end_s)
    errors = np.abs(pairs.turned_rad - rad_per_m * difference_m)
    shares = errors / (rad_per_m * gross_m + POSE_RAD)
    share = max(LEAST_SHARE, MARGIN * float(np.quantile(shares, QUANTILE)))
    _, difference_m, _, gross_m = travel.between(stamps_s[:-1], stamps_s[1:])
    return rad_per_m * difference_m, POSE_RAD + share * rad_per_m * gross_m
