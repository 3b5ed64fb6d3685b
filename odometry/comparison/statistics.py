"""Differences of models on the same windows, with bootstrap intervals."""

from collections.abc import Sequence
from dataclasses import dataclass
from itertools import combinations

import numpy as np

from odometry.arrays import AnyArray, FloatArray
from odometry.comparison.config import ComparisonConfig
from odometry.comparison.evaluation import Evaluation
from odometry.comparison.summary import QUANTITIES, Place, values_of
from odometry.identification.fitted import NORMAL, deviations_within

FEW_WINDOWS = 10  # fewer show too little of their own spread: Student's t widens the interval
FEW_RUNS = 10  # fewer, too, show too little of how runs differ
LEAST_BLOCKS = 5  # of a run, however long the blocks should be
COVERED = (2.5, 97.5)  # percentiles of the 95 % interval
ROUNDING = 1e-12  # a smaller value is one of arithmetic: models that are the same differ by it


@dataclass(frozen=True)
class Interval:
    """A mean with its 95 % interval."""

    mean: float
    low: float
    high: float

    @property
    def holds_zero(self) -> bool:
        """Whether the mean cannot be distinguished from zero."""
        return self.low <= 0 <= self.high

    def widened(self, by: float) -> "Interval":
        """With an independent error of the mean, half of whose 95 % interval is `by`."""
        below, above = np.hypot(self.mean - self.low, by), np.hypot(self.high - self.mean, by)
        return Interval(self.mean, float(self.mean - below), float(self.mean + above))


def mean_interval(
    values: FloatArray, runs: AnyArray, block: int, draws: int, rng: np.random.Generator
) -> Interval:
    """The mean of values with its percentile interval from a bootstrap of two levels.

    Each draw takes as many runs as there are, with replacement, and of each of these blocks of
    neighbouring windows, with replacement too (moving blocks around a circle: Politis and Romano
    1992). What differs from run to run widens the interval; for windows that are independent, it
    is up to sqrt(2) times wider than it need be. With one run, blocks alone are drawn. Of fewer
    than FEW_WINDOWS it is as much wider as Student's t asks for (Hesterberg 2015, expanded
    percentiles); one value has no interval: it is infinite.

    Fewer than FEW_RUNS that differ are too few to draw from: it is then as wide as Student's t asks
    for at the least, by what lies between runs and what within (Satterthwaite).

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
    values = np.where(np.abs(values) < ROUNDING, 0.0, values)
    of_runs = [values[runs == run] for run in dict.fromkeys(runs)]
    sizes = np.array([len(of_run) for of_run in of_runs])
    drawn = rng.integers(len(of_runs), size=(draws, len(of_runs)))
    means = np.empty(drawn.size)
    variances = np.zeros(len(of_runs))
    counts = np.bincount(drawn.ravel(), minlength=len(of_runs))
    places = np.split(np.argsort(drawn, axis=None, kind="stable"), np.cumsum(counts)[:-1])
    for i, (of_run, here) in enumerate(zip(of_runs, places, strict=True)):
        means[here] = _block_means(of_run, block, len(here), rng)
        variances[i] = means[here].var()
    weights = sizes[drawn]
    totals = np.sum(weights * means.reshape(drawn.shape), axis=1) / np.sum(weights, axis=1)
    if len(values) == 1:
        return Interval(float(values[0]), -np.inf, np.inf)
    mean = float(values.mean())
    ends = mean + _widening(len(values)) * (np.percentile(totals, COVERED) - mean)
    low, high = ends.tolist()
    half = _half_of_runs(of_runs, variances, len(values) / block)
    return Interval(mean, min(low, mean - half), max(high, mean + half))


def _half_of_runs(of_runs: Sequence[FloatArray], variances: FloatArray, blocks: float) -> float:
    """Half of the interval of a mean over few runs (R,); 0 where runs differ by chance alone.

    `variances` (R,) are of the mean of each run by its own windows. What runs differ by beyond
    them is known from R - 1 differences alone: Student's t, with the degrees of freedom of Welch
    and Satterthwaite for the sum of both.
    """
    if not 2 <= len(of_runs) < FEW_RUNS:
        return 0.0
    sizes = np.array([len(of_run) for of_run in of_runs])
    weights = sizes / sizes.sum()
    means = np.array([of_run.mean() for of_run in of_runs])
    freedom = len(of_runs) - 1.0
    all_of_it = np.sum((weights * (means - weights @ means)) ** 2) * len(of_runs) / freedom
    within = float(np.sum(weights**2 * variances))
    between = max(float(all_of_it) - within, 0.0)
    if between == 0:
        return 0.0
    uncertain = between**2 / freedom + within**2 / max(blocks - len(of_runs), 1.0)
    degrees = np.array(max((between + within) ** 2 / uncertain, 1.0))
    return float(deviations_within(degrees) * np.sqrt(between + within))


def _widening(count: int) -> float:
    """How many times an interval of percentiles of so many values is too narrow."""
    if count >= FEW_WINDOWS:
        return 1.0
    return float(deviations_within(np.array(count - 1.0)) / NORMAL * np.sqrt(count / (count - 1)))


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


@dataclass(frozen=True)
class Difference:
    """Mean error of one model less that of another, over windows that both were evaluated on.

    Attributes
    ----------
    place : Place
    quantity : str
    first, second : str
    windows : int
    interval : Interval
        Below 0 where the first has the smaller error, in the unit of the quantity.
    """

    place: Place
    quantity: str
    first: str
    second: str
    windows: int
    interval: Interval

    def with_first(self, model: str) -> "Difference":
        """The same with `model` first."""
        if model == self.first:
            return self
        turned = Interval(-self.interval.mean, -self.interval.high, -self.interval.low)
        return Difference(self.place, self.quantity, self.second, self.first, self.windows, turned)

    def words(self) -> str:
        """The difference with its interval and unit."""
        numbers = (self.interval.mean, self.interval.low, self.interval.high)
        decimals = 4 if self.quantity == "translation" else 3
        mean, low, high = (f"{round(number, decimals) + 0.0:.{decimals}f}" for number in numbers)
        return f"{mean} [{low}, {high}] {QUANTITIES[self.quantity]}"


def differences(
    place: Place,
    evaluations: Sequence[Evaluation],
    models: Sequence[str],
    config: ComparisonConfig,
    yaw_sigma_rad: float = 0.0,
) -> list[Difference]:
    """Paired differences of all models at one place, for both quantities; none of one window.

    `yaw_sigma_rad` is the standard deviation of yaws that are all off alike, as those found from
    positions may be: what lies aside of a metre of way is then off by so many metres.
    """
    block = max(1, round(config.block_m / place.horizon_m))
    found = []
    for first, second in combinations(models, 2):
        both = [each for each in evaluations if {first, second} <= set(each.errors)]
        if not both:
            continue
        runs = np.repeat(np.arange(len(both)), [len(each.windows) for each in both])
        if len(runs) < 2:
            continue
        for quantity in QUANTITIES:
            values = np.concatenate(
                [
                    values_of(each.errors[first], quantity)
                    - values_of(each.errors[second], quantity)
                    for each in both
                ]
            )
            rng = np.random.default_rng(config.seed)
            interval = mean_interval(values, runs, block, config.draws, rng)
            if quantity == "translation" and yaw_sigma_rad:
                interval = interval.widened(NORMAL * yaw_sigma_rad)
            found.append(Difference(place, quantity, first, second, len(values), interval))
    return found


def between(found: Sequence[Difference], first: str, second: str) -> Difference | None:
    """The difference of two models with the first one first; None where no window is shared."""
    for difference in found:
        if {difference.first, difference.second} == {first, second}:
            return difference.with_first(first)
    return None
