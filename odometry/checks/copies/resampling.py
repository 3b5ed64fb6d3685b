"""How a program may take the rows of one column at the stamps of another."""

from collections.abc import Callable
from functools import partial

import numpy as np

from odometry.arrays import FloatArray

SAME_STAMP_S = 1e-9

Sampled = Callable[[FloatArray, float, FloatArray, FloatArray], FloatArray]


def ways(at_s: FloatArray, source_s: FloatArray) -> tuple[Sampled, ...]:
    """How a program may take a source at stamps (N,) less a delay."""
    if not np.array_equal(at_s, source_s):
        return _between_rows, _held, _mean_to_next
    return _between_rows, partial(_by_row, float(np.median(np.diff(source_s))))


def _between_rows(
    at_s: FloatArray, delay_s: float, source_s: FloatArray, source: FloatArray
) -> FloatArray:
    return np.interp(at_s - delay_s, source_s, source)


def _by_row(
    period_s: float, at_s: FloatArray, delay_s: float, source_s: FloatArray, source: FloatArray
) -> FloatArray:
    """The same number of rows later throughout, however uneven the stamps are."""
    rows = np.searchsorted(source_s, at_s) - round(delay_s / period_s)
    return np.asarray(source[np.clip(rows, 0, len(source) - 1)])


def _held(at_s: FloatArray, delay_s: float, source_s: FloatArray, source: FloatArray) -> FloatArray:
    rows = np.searchsorted(source_s, at_s - delay_s + SAME_STAMP_S, side="right") - 1
    return np.asarray(source[np.clip(rows, 0, None)])


def _mean_to_next(
    at_s: FloatArray, delay_s: float, source_s: FloatArray, source: FloatArray
) -> FloatArray:
    """What a program that integrates held values adds up between two stamps, for each second."""
    summed = np.concatenate([[0.0], np.cumsum(source[:-1] * np.diff(source_s))])
    edges_s = np.append(at_s, 2 * at_s[-1] - at_s[-2])
    return np.asarray(np.diff(np.interp(edges_s - delay_s, source_s, summed)) / np.diff(edges_s))


def low_pass(sources: FloatArray, smoothed_s: float, period_s: float) -> FloatArray:
    """Sources (S,) or (S, P) through a low pass of first order, at rest before the first row."""
    from scipy.signal import lfilter  # noqa: PLC0415 - slow to load

    if smoothed_s < period_s / 10:
        return sources
    kept = np.exp(-period_s / smoothed_s)
    return np.asarray(lfilter([1 - kept], [1, -kept], sources, axis=0, zi=kept * sources[:1])[0])
