"""Medians of measurements that carry weights."""

import numpy as np

from odometry.arrays import FloatArray

NORMAL = 1.4826  # of the median absolute deviation of normal errors, their standard deviation


def weighted_median(values: FloatArray, weights: FloatArray) -> float:
    """The value that halves the weight (N,) of values (N,)."""
    order = np.argsort(values)
    summed = np.cumsum(weights[order])
    return float(values[order][np.searchsorted(summed, summed[-1] / 2)])


def slope(steps: FloatArray, by: FloatArray) -> float:
    """The factor of steps (N,) by what they answer to (N,), of which half is not zero.

    The weighted median of their ratios makes the sum of the absolute deviations least.
    """
    known = by != 0
    return weighted_median(steps[known] / by[known], np.abs(by[known]))


def spread(errors: FloatArray) -> float:
    """Standard deviation of the normal part of errors (N,)."""
    return float(NORMAL * np.median(np.abs(errors - np.median(errors))))
