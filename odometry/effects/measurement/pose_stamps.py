"""What the stamps of poses say by themselves: where their clock was set, and which came by chance.

A reference measures at even intervals. A stamp that is off them was not given when the pose was
measured, or a pose is missing.
"""

import numpy as np

from odometry.arrays import FloatArray

MOST = 8  # breaks of a run, the largest
LEAST = 0.25  # of the usual spacing, by which a break differs from it
RARE = 0.05  # share of the spacings that may differ as much: more are stamps of no clock
AROUND = 25  # stamps to each side, whose mean is that of an even clock


def breaks_s(stamps_s: FloatArray) -> tuple[float, ...]:
    """Middles of the spacings of stamps (M,) that are not as usual, the largest breaks first."""
    spacings_s = np.diff(stamps_s)
    usual_s = float(np.median(spacings_s)) if len(spacings_s) else 0.0
    off_s = np.abs(spacings_s - usual_s)
    broken = np.flatnonzero(off_s > LEAST * usual_s)
    if len(broken) > RARE * len(spacings_s):
        return ()
    largest = broken[np.argsort(-off_s[broken], kind="stable")][:MOST]
    return tuple((stamps_s[largest] + spacings_s[largest] / 2).tolist())


def uneven_s(stamps_s: FloatArray) -> FloatArray:
    """By how much each stamp (M,) is later than even ones would be, by those around it."""
    count = len(stamps_s)
    if count < 2:
        return np.zeros_like(stamps_s)
    line_s = np.linspace(stamps_s[0], stamps_s[-1], count)
    summed = np.concatenate([[0.0], np.cumsum(stamps_s - line_s)])
    rows = np.arange(count)
    reach = np.minimum(np.minimum(rows, count - 1 - rows), AROUND)
    mean_s = (summed[rows + reach + 1] - summed[rows - reach]) / (2 * reach + 1)
    return np.asarray(stamps_s - line_s - mean_s)
