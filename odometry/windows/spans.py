"""Spans of time that others touch."""

import numpy as np

from odometry.arrays import BoolArray, FloatArray


def touched(spans_s: FloatArray, begin_s: FloatArray, end_s: FloatArray) -> BoolArray:
    """Whether any of the spans (G, 2), in order and apart, overlaps each time (K,) to (K,)."""
    ended = np.searchsorted(spans_s[:, 1], begin_s, side="right")
    begun = np.searchsorted(spans_s[:, 0], end_s, side="left")
    return np.asarray(begun > ended)
