"""Rates of headings at many delays, and what these leave of those of another sensor."""

from collections.abc import Iterable

import numpy as np

from odometry.arrays import FloatArray, IntArray
from odometry.checks.evidence.evidence import Evidence
from odometry.checks.stamps.timing import pose_period_s
from odometry.checks.statistics.lag import Signal

GRID_S, STEP_S = 0.05, 0.02  # of the stamps at which rates are compared, and of delays
LEAST_WIDTH_S = 0.3  # over which rates are taken
MOST_TIMES = 8000  # at which rates are compared
PARTS, LEAST_PARTS = 100, 5  # of the recording, between which a clock may be set


def width_s(evidence: Evidence, pair: tuple[str, str]) -> float:
    """Over which the rates of a pair of `headings_by_sensor` are taken [s]."""
    period_s = pose_period_s(evidence) if "pose" in pair else 0.0
    return max(LEAST_WIDTH_S, 2 * period_s, 2 * evidence.period_s)


def rate(heading: Signal, at_s: FloatArray, width_s: float) -> FloatArray:
    """Rates (N,) of a heading over a width around some stamps (N,)."""
    return (heading(at_s + width_s / 2) - heading(at_s - width_s / 2)) / width_s


def centred(rates: FloatArray) -> FloatArray:
    """Rates (..., N) less their means, as of a bias."""
    return np.asarray(rates - rates.mean(axis=-1, keepdims=True))


def left_by(measured: FloatArray, by: FloatArray) -> FloatArray:
    """Squares (D,) of measured rates (N,) that each of some rates (D, N) leaves, times a gain."""
    explained = (by @ measured) ** 2 / np.maximum(np.sum(by**2, axis=1), 1e-300)
    return np.asarray(np.sum(measured**2) - explained)


def two_delays(squares: FloatArray) -> tuple[float, int, int, float]:
    """What the best two rows of squares (D, N) leave, one before and one after the best moment.

    Returns
    -------
    left : float
    before, after : int
        Rows.
    share : float
        Of the columns, that are before the moment.
    """
    edges = np.linspace(0, squares.shape[1], PARTS + 1).astype(int)[:-1]
    before = np.cumsum(np.add.reduceat(squares, edges, axis=1), axis=1)
    after = before[:, -1:] - before
    left = (before.min(axis=0) + after.min(axis=0))[LEAST_PARTS:-LEAST_PARTS]
    part = int(np.argmin(left)) + LEAST_PARTS
    rows = int(np.argmin(before[:, part])), int(np.argmin(after[:, part]))
    return float(left.min()), *rows, (part + 1) / PARTS


def left_by_growing(
    squares: FloatArray, delays_s: FloatArray, lags_s: Iterable[FloatArray]
) -> float:
    """The least of squares (D, N) by even delays (D,) that one of some lags, each (N,), leaves."""
    every, step_s = np.arange(squares.shape[1]), float(delays_s[1] - delays_s[0])
    rows = (np.round((of - delays_s[0]) / step_s).astype(int) for of in lags_s)
    return min(float(np.sum(squares[np.clip(of, 0, len(delays_s) - 1), every])) for of in rows)


def left_by_any_growing(squares: FloatArray, growths: Iterable[IntArray]) -> float:
    """The least of squares (D, N) that a lag leaves which is any of the D delays and grows.

    Parameters
    ----------
    squares : FloatArray, shape (D, N)
    growths : iterable of IntArray, shape (N,)
        By how many rows each possible lag is farther on at each stamp; beyond the last delay it
        stays.
    """
    rows, columns = squares.shape
    summed = np.pad(np.cumsum(squares, axis=1), ((0, 0), (1, 0)))
    least = np.inf
    for growth in growths:  # the sums of stretches in which it is the same
        begins = np.append(0, np.flatnonzero(np.diff(growth)) + 1)
        stretches = np.diff(summed[:, np.append(begins, columns)], axis=1)
        at = np.clip(np.arange(rows)[:, None] + growth[begins], 0, rows - 1)
        least = min(least, float(np.take_along_axis(stretches, at, axis=0).sum(axis=1).min()))
    return least


def moment_of(stamps_s: FloatArray, share: float) -> float:
    """The stamp after a share of stamps (N,)."""
    return float(stamps_s[min(int(share * len(stamps_s)), len(stamps_s) - 1)])
