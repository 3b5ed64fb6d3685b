"""Single samples that no robot can drive."""

import numpy as np

from odometry.arrays import BoolArray, FloatArray

NEIGHBOURS = 4.0  # a spike exceeds both neighbours by this many ordinary steps (99 in 100)
OF_FASTEST = 0.6  # and by this share of the ordinary fastest value (99 in 100)
LONGEST = 3  # samples of a spike


def spikes(values: FloatArray) -> BoolArray:
    """Which of the samples (N,) go out and come back at once, far beyond what is usual.

    A step that stays is none: treads start and stop, and latched speeds jump.
    """
    if len(values) < 10:
        return np.zeros(len(values), dtype=np.bool_)
    ordinary = min(0.99, 1 - 2 * LONGEST / len(values))  # one spike is not to be ordinary
    usual_step = np.quantile(np.abs(np.diff(values)), ordinary)
    fastest = np.quantile(np.abs(values), ordinary)
    least = max(NEIGHBOURS * float(usual_step), OF_FASTEST * float(fastest), 1e-9)
    found = np.zeros(len(values), dtype=np.bool_)
    for length in range(1, LONGEST + 1):
        before, after = values[: -length - 1], values[length + 1 :]
        inside = np.lib.stride_tricks.sliding_window_view(values[1:-1], length)
        higher = inside.min(axis=1) - np.maximum(before, after)
        lower = np.minimum(before, after) - inside.max(axis=1)
        begins = np.flatnonzero(np.maximum(higher, lower) > least) + 1
        for offset in range(length):
            found[begins + offset] = True
    return found


def without_spikes(values: FloatArray) -> FloatArray:
    """The values (N,) with spikes replaced by a line between their neighbours."""
    odd = spikes(values) | ~np.isfinite(values)
    if not odd.any() or odd.all():
        return values
    rows = np.arange(len(values))
    return np.asarray(np.interp(rows, rows[~odd], values[~odd]))
