"""Values between samples, where these are near each other: nothing is known across a gap."""

import numpy as np

from odometry.arrays import FloatArray, median
from odometry.windows.recorded.spans import touched

# Between samples, or usual periods: the longer of both is no gap, and values between lie on a line.
LONGEST_S, LONGEST = 0.5, 3.0


def gaps_between(stamps_s: FloatArray) -> FloatArray:
    """Spans (S, 2) between two neighbours of stamps (M,) that are far apart."""
    lasts_s = np.diff(stamps_s)
    if not len(lasts_s):
        return np.empty((0, 2))
    long = np.flatnonzero(lasts_s > max(LONGEST_S, LONGEST * median(lasts_s)))
    return np.stack([stamps_s[long], stamps_s[long + 1]], axis=-1)


def measured_between(at_s: FloatArray, stamps_s: FloatArray, values: FloatArray) -> FloatArray:
    """Values (K,) at stamps (K,), on lines between samples (M,); NaN outside and in gaps."""
    found = np.interp(at_s, stamps_s, values, left=np.nan, right=np.nan)
    return np.where(touched(gaps_between(stamps_s), at_s, at_s), np.nan, found)
