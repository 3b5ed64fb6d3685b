"""Intervals that hold a parameter with a stated probability."""

from dataclasses import dataclass

import numpy as np
from scipy.special import stdtrit

from odometry.arrays import FloatArray

LEVEL = 0.95
NORMAL = 1.96  # standard deviations of a normal distribution on each side at that level


@dataclass(frozen=True)
class Interval:
    """A 95 % interval of a parameter.

    Attributes
    ----------
    low, high : float
    freedom : float
        Degrees of freedom of the variance behind it; with few, Student's t makes it wide.
    """

    low: float
    high: float
    freedom: float


def deviations_within(freedom: FloatArray) -> FloatArray:
    """Standard deviations on each side of a 95 % interval by Student's t."""
    return np.asarray(stdtrit(freedom, (1 + LEVEL) / 2))
