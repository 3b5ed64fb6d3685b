"""Whether the most probable mode turns by as much as it says, to either side and to both.

A gain between those of two modes leaves innovations to the side of the turn. Over turns to both
sides they cancel in a plain sum (see `innovation_test`); here they are summed for left turns, for
right turns, and for both by the side of the turn, each weighted by the yaw rate that was asked for:
the score test of the gain of the mode (Rao 1948).
"""

import numpy as np

from odometry.arrays import BoolArray, FloatArray
from odometry.modes.innovation_test import Innovations, windowed
from odometry.modes.modes_config import ModesConfig

WINDOWS_S = (6.0, 12.0)
CLIP = 3.0  # of one innovation
LEAST_RAD_S = 0.05  # asked for: less is no turn


def turns_are_off(
    innovations: Innovations, asked_rad_s: FloatArray, config: ModesConfig | None = None
) -> BoolArray:
    """Where (N,) turns contradict the most probable mode.

    Parameters
    ----------
    innovations : Innovations
        The yaw rate is the last measured entry.
    asked_rad_s : (N, M)
        Steady yaw rate of each mode for the speeds in force before each stamp.
    config : ModesConfig, optional
        `turn_sigmas` were chosen on seeds 50, 51 and 60 to 63 of `tests/studies/modes_faults.py`:
        of 18 clean runs 3 have a sum beyond 3.5 somewhere.
    """
    config = config or ModesConfig()
    sums = [turn_sums(innovations, asked_rad_s, window_s) for window_s in WINDOWS_S]
    off = np.asarray((np.abs(sums) > config.turn_sigmas).any(axis=(0, 2)))
    last = np.maximum.accumulate(np.where(off, np.arange(len(off)), -1))
    since_s = innovations.stamps_s - innovations.stamps_s[last]
    return np.asarray((last >= 0) & (since_s <= config.turn_holds_s))


def turn_sums(innovations: Innovations, asked_rad_s: FloatArray, window_s: float) -> FloatArray:
    """Sums (N, 3) over left turns, right turns and both in a window up to each stamp.

    In their standard deviations if the mode is true; positive: more was turned than it says.
    """
    rows = np.arange(len(innovations.leading))
    asked = asked_rad_s[rows, innovations.leading]
    left_over = innovations.of_leading[:, -1]
    known = np.isfinite(left_over)
    clipped = np.where(known, np.clip(np.nan_to_num(left_over), -CLIP, CLIP), 0.0)
    sides = []
    for side in (1, -1):
        weights = np.where(known & (side * asked > LEAST_RAD_S), asked, 0.0)
        columns = np.column_stack([weights * clipped, weights**2, np.abs(weights)])
        summed, squares, sizes = windowed(columns, innovations.stamps_s, window_s).T
        variances = np.minimum(squares / innovations.independent, sizes**2)
        sides.append(summed / np.sqrt(np.maximum(variances, 1e-9)))
    left, right = sides
    return np.column_stack([left, right, (left + right) / np.sqrt(2.0)])
