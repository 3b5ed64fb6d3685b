"""Which of two models errs less, on the same windows, and how certain that is."""

from collections.abc import Sequence
from dataclasses import dataclass
from itertools import combinations

import numpy as np

from odometry.comparison.bootstrap import Interval, mean_interval
from odometry.comparison.config import ComparisonConfig
from odometry.comparison.judgement import Judgement
from odometry.comparison.summary import QUANTITIES, Place, values_of


@dataclass(frozen=True)
class Difference:
    """Mean error of one model less that of another, over windows that both were judged on.

    Attributes
    ----------
    place : Place
    quantity : str
    first, second : str
    windows : int
    interval : Interval
        Below 0 where the first errs less, in the unit of the quantity.
    """

    place: Place
    quantity: str
    first: str
    second: str
    windows: int
    interval: Interval

    def seen_from(self, model: str) -> "Difference":
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
    judgements: Sequence[Judgement],
    models: Sequence[str],
    config: ComparisonConfig,
) -> list[Difference]:
    """Paired differences of all models at one place, for both quantities."""
    block = max(1, round(config.block_m / place.horizon_m))
    found = []
    for first, second in combinations(models, 2):
        both = [each for each in judgements if {first, second} <= set(each.errors)]
        if not both:
            continue
        runs = np.repeat(np.arange(len(both)), [len(each.judged) for each in both])
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
            found.append(Difference(place, quantity, first, second, len(values), interval))
    return found


def between(found: Sequence[Difference], first: str, second: str) -> Difference | None:
    """The difference of two models as seen from the first; None where no window is shared."""
    for difference in found:
        if {difference.first, difference.second} == {first, second}:
            return difference.seen_from(first)
    return None
