"""About which points a robot turns in the runs that modes are identified from."""

from collections.abc import Sequence

import numpy as np

from odometry.modes.recorded.turning_points import turning_points
from odometry.recording.run import Run

LEAST_WINDOWS = 100  # they end each half second


def turning_range(runs: Sequence[Run]) -> tuple[float, float]:
    """Least and most [m] over all terrains and turns; NaN where too few windows turn.

    Each window less its own standard deviation: what noise moves is not allowed later. Terrains
    move the point by chance to one side, so that a spread about a mean does not hold it.
    """
    found = [of for of in map(turning_points, runs) if of is not None]
    if sum(len(of.ends_s) for of in found) < LEAST_WINDOWS:
        return np.nan, np.nan
    ahead_m = np.concatenate([of.ahead_m for of in found])
    sigma_m = np.concatenate([of.sigma_m for of in found])
    usual_m = float(np.median(ahead_m))
    least_m, most_m = float((ahead_m + sigma_m).min()), float((ahead_m - sigma_m).max())
    return min(least_m, usual_m), max(most_m, usual_m)
