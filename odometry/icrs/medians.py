"""Medians of measured ICRs by terrain and by the side of the turn."""

from dataclasses import dataclass

import numpy as np

from odometry.arrays import AnyArray, FloatArray, IntArray
from odometry.icrs.measured import MeasuredIcrs

LEAST_WINDOWS = 10  # fewer give no interval
BLOCK, LEAST_BLOCKS = 5, 5  # neighbouring windows that are drawn together; of a run, at least
DRAWS = 500
COVERED = (2.5, 97.5)  # percentiles of the 95 % interval


@dataclass(frozen=True)
class IcrMedian:
    """What most windows of one terrain and one side say.

    Attributes
    ----------
    terrain : str
    side : str
        "left" or "right".
    windows : int
    icrs : (3,)
        Medians of y_left, y_right, x_icr [m].
    low, high : (3,)
        Their 95 % intervals; NaN of fewer than `LEAST_WINDOWS`.
    """

    terrain: str
    side: str
    windows: int
    icrs: FloatArray
    low: FloatArray
    high: FloatArray


def icr_medians(measured: MeasuredIcrs, *, seed: int = 0) -> tuple[IcrMedian, ...]:
    """Medians of ICRs, terrain by terrain, of left turns and of right turns.

    A point counts by the inverse of its standard deviation. Intervals are bootstrapped: runs are
    drawn with replacement, and of each blocks of five neighbouring windows. Of one run they do
    not hold what differs from run to run.

    Examples
    --------
    >>> import odometry
    >>> run = odometry.Run.read(odometry.shipped_data() / "runs" / "demo")
    >>> left, right = odometry.icr_medians(odometry.measured_icrs([run]))
    >>> left.side, left.icrs.shape
    ('left', (3,))
    """
    found = []
    for terrain in sorted(set(measured.terrain)):
        for side in ("left", "right"):
            here = measured.where((measured.terrain == terrain) & (measured.side == side))
            if len(here):
                found.append(_median(here, terrain, side, np.random.default_rng(seed)))
    return tuple(found)


def _median(measured: MeasuredIcrs, terrain: str, side: str, rng: np.random.Generator) -> IcrMedian:
    weights = 1 / measured.sigmas_m
    once = np.ones((1, len(measured)), dtype=np.int64)
    icrs = _weighted_medians(measured.icrs, weights, once)[0]
    low = high = np.full(3, np.nan)
    if len(measured) >= LEAST_WINDOWS:
        counts = _drawn(measured.run, rng)
        low, high = np.percentile(
            _weighted_medians(measured.icrs, weights, counts), COVERED, axis=0
        )
    return IcrMedian(terrain, side, len(measured), icrs, low, high)


def _weighted_medians(values: FloatArray, weights: FloatArray, counts: IntArray) -> FloatArray:
    """Medians (D, 3) of values (K, 3), each of which is there so many times (D, K)."""
    medians = np.empty((len(counts), values.shape[1]))
    for column, (of_column, weight) in enumerate(zip(values.T, weights.T, strict=True)):
        order = np.argsort(of_column)
        summed = np.cumsum((counts * weight)[:, order], axis=1)
        halves = np.argmax(summed >= summed[:, -1:] / 2, axis=1)
        medians[:, column] = of_column[order][halves]
    return medians


def _drawn(runs: AnyArray, rng: np.random.Generator) -> IntArray:
    """How often each window (K,) is in each of `DRAWS` draws of runs and blocks."""
    of_runs = [np.flatnonzero(runs == run) for run in dict.fromkeys(runs)]
    counts = np.zeros((DRAWS, len(runs)), dtype=np.int64)
    for row in counts:
        for number in rng.integers(len(of_runs), size=len(of_runs)):
            rows = of_runs[number]
            block = max(1, min(BLOCK, len(rows) // LEAST_BLOCKS))
            starts = rng.integers(len(rows), size=-(-len(rows) // block))
            drawn = (starts[:, None] + np.arange(block)) % len(rows)
            np.add.at(row, rows[drawn.ravel()], 1)
    return counts
