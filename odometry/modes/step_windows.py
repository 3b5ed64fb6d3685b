"""Sums over windows of steps from one measured pose to the next, and for when they hold."""

from dataclasses import dataclass

import numpy as np

from odometry.arrays import BoolArray, FloatArray, IntArray

EVERY_S = 0.5  # from a window to the next
LEAST_STEPS = 10  # of a window


@dataclass(frozen=True)
class StepWindows:
    """Windows over K steps, each ended by a stamp.

    Attributes
    ----------
    ends_s : (W,)
    first, after : (W,)
        Its first step, and the one after its last.
    """

    ends_s: FloatArray
    first: IntArray
    after: IntArray

    def __len__(self) -> int:
        return len(self.ends_s)

    def sums(self, values: FloatArray) -> FloatArray:
        """Of values (..., K) in each window (..., W); NaN where one of them is."""
        known = np.isfinite(values)
        whole, missing = (
            np.concatenate([np.zeros((*of.shape[:-1], 1)), np.cumsum(of, axis=-1)], axis=-1)
            for of in (np.where(known, values, 0.0), ~known)
        )
        complete = missing[..., self.after] == missing[..., self.first]
        return np.where(complete, whole[..., self.after] - whole[..., self.first], np.nan)

    def in_force(self, stamps_s: FloatArray, holds_s: float) -> tuple[IntArray, BoolArray]:
        """The last window (N,) before each stamp; whether (N,) it is no older than `holds_s`."""
        last = np.searchsorted(self.ends_s, stamps_s, side="right") - 1
        return last, (last >= 0) & (stamps_s - self.ends_s[last] <= holds_s)


def step_windows(begin_s: FloatArray, end_s: FloatArray, window_s: float) -> StepWindows:
    """Windows of so long over steps (K,), those with fewer than LEAST_STEPS left out."""
    ends_s = np.arange(begin_s[0] + window_s, end_s[-1] + 1e-9, EVERY_S)
    first = np.searchsorted(begin_s, ends_s - window_s - 1e-9)
    after = np.searchsorted(end_s, ends_s + 1e-9, side="right")
    enough = after - first >= LEAST_STEPS
    return StepWindows(ends_s[enough], first[enough], after[enough])


def during(
    begin_s: FloatArray, end_s: FloatArray, stamps_s: FloatArray, rates: FloatArray
) -> FloatArray:
    """Integrals (..., K) of rates (..., N) at stamps over each step, by the trapezoidal rule."""
    means = (rates[..., 1:] + rates[..., :-1]) / 2 * np.diff(stamps_s)
    whole = np.concatenate([np.zeros((*rates.shape[:-1], 1)), np.cumsum(means, axis=-1)], axis=-1)
    at_end, at_begin = (_interpolated(at_s, stamps_s, whole) for at_s in (end_s, begin_s))
    return np.asarray(at_end - at_begin)


def _interpolated(at_s: FloatArray, stamps_s: FloatArray, values: FloatArray) -> FloatArray:
    rows = values.reshape(-1, values.shape[-1])
    found = np.array([np.interp(at_s, stamps_s, row) for row in rows])
    return found.reshape(*values.shape[:-1], len(at_s))
