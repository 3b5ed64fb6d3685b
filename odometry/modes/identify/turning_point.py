"""About which point a robot turns in the runs that modes are identified from."""

from collections.abc import Sequence

import numpy as np

from odometry.modes.measured_steps import EVERY_S
from odometry.modes.turning_points import WINDOW_S, turning_points
from odometry.run import Run

LEAST_WINDOWS = 8
OVERLAP = 2  # windows overlap by half
LEAST_M = 0.02  # standard deviation of a window: one of no error would count alone


def turning_point(runs: Sequence[Run]) -> tuple[float, float]:
    """Mean and spread of the point over all terrains [m]; NaN where too few windows turn.

    The spread is that of windows beyond what their own errors explain: terrains and turns differ.
    """
    found = [of for of in map(turning_points, runs) if of is not None]
    every = round(WINDOW_S / OVERLAP / EVERY_S)
    columns = [(of.ahead_m[::every], of.sigma_m[::every]) for of in found]
    ahead_m, sigma_m = np.hstack(columns) if columns else np.empty((2, 0))
    if len(ahead_m) < LEAST_WINDOWS:
        return np.nan, np.nan
    weights = 1 / (sigma_m**2 + LEAST_M**2)
    mean = float(np.average(ahead_m, weights=weights))
    beyond = float(np.average((ahead_m - mean) ** 2 - sigma_m**2, weights=weights))
    return mean, float(np.sqrt(max(beyond, 0.0)))
