"""A first-order lag of values that are held from time to time."""

import numpy as np
from scipy.signal import lfilter

from odometry.arrays import FloatArray

SHORTEST_LAG_S = 1e-3


def lagged(values: FloatArray, time_s: FloatArray, lag_s: float) -> FloatArray:
    """Values (N,) at times (N,), each held to the next, as a first-order lag follows them."""
    since_s = time_s - time_s[0]
    steps = max(1, round(float(since_s[-1] / np.median(np.diff(since_s)))))
    even_s, step_s = np.linspace(0.0, since_s[-1], steps + 1, retstep=True)
    held = values[np.searchsorted(since_s, even_s + 1e-3 * step_s, side="right") - 1]
    lasting = np.exp(-step_s / max(lag_s, SHORTEST_LAG_S))
    followed, _ = lfilter([0.0, 1 - lasting], [1.0, -lasting], held, zi=held[:1])
    return np.asarray(np.interp(since_s, even_s, followed))
