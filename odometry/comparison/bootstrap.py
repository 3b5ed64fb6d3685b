"""How certain a mean over windows is, when neighbours and windows of one run err alike."""

from dataclasses import dataclass

import numpy as np

from odometry.arrays import AnyArray, FloatArray

LEAST_BLOCKS = 5  # of a run, however long the blocks should be
COVERED = (2.5, 97.5)  # percentiles of the 95 % interval


@dataclass(frozen=True)
class Interval:
    """A mean with its 95 % interval."""

    mean: float
    low: float
    high: float

    @property
    def holds_zero(self) -> bool:
        """Whether the mean cannot be told from nothing."""
        return self.low <= 0 <= self.high


def mean_interval(
    values: FloatArray, runs: AnyArray, block: int, draws: int, rng: np.random.Generator
) -> Interval:
    """The mean of values with its percentile interval from a bootstrap of two levels.

    Each draw takes as many runs as there are, with replacement, and of each of these blocks of
    neighbouring windows, with replacement too (moving blocks around a circle: Politis and Romano
    1992). What differs from run to run widens the interval; for windows that are independent, it
    is up to sqrt(2) times wider than it need be. With one run, blocks alone are drawn.

    Parameters
    ----------
    values : (K,)
        In order of time within each run.
    runs : (K,)
        The run of each.
    block : int
        Windows of a block; less in a run that has not five such blocks.
    draws : int
    rng : numpy.random.Generator
    """
    of_runs = [values[runs == run] for run in dict.fromkeys(runs)]
    sizes = np.array([len(of_run) for of_run in of_runs])
    drawn = rng.integers(len(of_runs), size=(draws, len(of_runs)))
    means = np.empty(drawn.shape)
    for number, of_run in enumerate(of_runs):
        here = drawn == number
        means[here] = _block_means(of_run, block, int(here.sum()), rng)
    weights = sizes[drawn]
    totals = np.sum(weights * means, axis=1) / np.sum(weights, axis=1)
    low, high = np.percentile(totals, COVERED)
    return Interval(float(values.mean()), float(low), float(high))


def _block_means(
    values: FloatArray, block: int, draws: int, rng: np.random.Generator
) -> FloatArray:
    """Means (draws,) of values (K,) put together from blocks."""
    block = max(1, min(block, len(values) // LEAST_BLOCKS))
    around = np.concatenate([values, values[: block - 1]])
    sums = np.concatenate([[0.0], np.cumsum(around)])
    of_blocks = (sums[block:] - sums[:-block]) / block
    count = -(-len(values) // block)
    return np.asarray(of_blocks[rng.integers(len(values), size=(draws, count))].mean(axis=1))
