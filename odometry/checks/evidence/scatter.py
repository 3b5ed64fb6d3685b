"""How the noise of poses shows in the motion of windows."""

import numpy as np

from odometry.checks.evidence.motion import Motion
from odometry.checks.statistics.relation import Relation

LEAST_PAIRS = 8
MOVING = 0.1  # share of the fast windows above which the robot moves
ON_THE_SPOT = 0.2  # share of the difference of the treads: with less in common nothing goes ahead
GENTLE_RAD = 0.5  # turn of a window: two of them hardly differ by it
# Change from one window to the next, of the usual way: of treads, and of noise (0.6 of its length).
EVENLY, UNEVENLY = 0.2, 0.4


def scattered(motion: Motion, width_m: float) -> bool:
    """Whether noise makes displacements long: they differ from one to the next by as much.

    By windows that are nearly straight; by those of gentle turns where there are hardly any; else
    by their lengths, which in small circles at an even speed are alike.
    """
    if len(motion) < LEAST_PAIRS:
        return False
    mean_m, distance_m = np.abs(motion.mean_m), motion.distance_m
    moving = mean_m > MOVING * np.quantile(mean_m, 0.9)
    known = np.isfinite(distance_m[1:] + distance_m[:-1])
    known &= motion.start_s[1:] == motion.end_s[:-1]
    straight = mean_m > np.abs(motion.difference_m)
    gentle = motion.least_turn_rad(width_m) < GENTLE_RAD
    gentle &= mean_m > ON_THE_SPOT * np.abs(motion.difference_m)
    for even in (straight, gentle):
        pairs = known & (moving & even)[1:] & (moving & even)[:-1]
        if pairs.sum() >= LEAST_PAIRS:
            change_m = np.hypot(*np.diff(motion.moved_m, axis=0).T)[pairs]
            return bool(np.median(change_m) > np.median(distance_m[1:][pairs]))
    pairs = known & moving[1:] & moving[:-1]
    if pairs.sum() < LEAST_PAIRS:
        return False
    (by_treads_m, even_m), (measured_m, usual_m) = (
        (np.median(np.abs(np.diff(way_m))[pairs]), np.median(way_m[1:][pairs]))
        for way_m in (mean_m, distance_m)
    )
    return bool(by_treads_m < EVENLY * even_m and measured_m > UNEVENLY * usual_m)


def noise_of_ends(motion: Motion, fit: Relation) -> float:
    """Standard deviation of the motion of windows (K,) by noise of the poses at their ends.

    The noise of a pose makes one window longer and the next one shorter; slip does not. It is taken
    from what a relation leaves of the measured motion, without outliers.
    """
    left = np.where(fit.kept, fit.residuals, np.nan)
    products = (left[1:] * left[:-1])[motion.start_s[1:] == motion.end_s[:-1]]
    known = products[np.isfinite(products)]
    return float(np.sqrt(2 * max(-np.mean(known), 0.0))) if len(known) else 0.0
