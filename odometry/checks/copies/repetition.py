"""How exactly one column repeats others: copied, delayed, filtered or resampled."""

from dataclasses import dataclass
from functools import cached_property
from math import comb

import numpy as np

from odometry.arrays import BoolArray, FloatArray, median
from odometry.checks.copies.resampling import Sampled, low_pass, ways
from odometry.checks.statistics.least_squares import least_squares

MOST_ROWS = 3000  # the liveliest ones, in which delay and filter are searched
LEAST_ROWS = 100
LEAST_CHANGES = 50  # of the values: a few held ones are repeated by chance
MOST_DELAY_S = 0.3
SMOOTHED_S = (0.0, 0.05, 0.1, 0.2, 0.3)  # time constants from which the search begins
LEAST_CORRELATION = 0.6  # of the changes, from which a search is worth its time
ROUNDED = 0.1  # of the squares of the changes, that rounding may leave: else nothing is known
FEW, REFINED = 10, 50  # evaluations
# Share of the changes left after a few evaluations, above which a search is given up: of 455 copies
# that were found in real recordings at most 0.39, of other columns mostly 0.6 and more.
HOPELESS = 0.6

ORDER = 2  # of the differences: what is smooth is alike in all sensors
OF_NOISE = comb(2 * ORDER, ORDER)  # mean square of such differences of a noise of one: binomials
ORDINARY = 0.95  # share of the changes that are not zero
EXACT = 1e-5  # share of the changes left, below which nothing is searched


@dataclass(frozen=True)
class Repetition:
    """`values = sources(delayed, smoothed) @ coefficients + constant`.

    Attributes
    ----------
    of_changes, of_values : float
        Share of the squares explained, of the changes from row to row and of the values; what
        rounding to the digits of the columns leaves is not counted.
    delay_s : float
        By which the values are later than the sources.
    smoothed_s : float
        Time constant of a low pass of first order through which the sources went.
    coefficients : (P,)
    noise : float
        Standard deviation of a white noise that would leave as much of the changes, in the unit of
        the values.
    """

    of_changes: float
    of_values: float
    delay_s: float
    smoothed_s: float
    coefficients: FloatArray
    noise: float


def repetition(
    at_s: FloatArray, values: FloatArray, source_s: FloatArray, sources: FloatArray
) -> Repetition | None:
    """How values come from sources of any stamps; None where their changes are not alike at all.

    Two sensors of one motion have noise of their own, and changes from row to row show it most.
    The changes of a copy are those of its source.

    Parameters
    ----------
    at_s, values : (N,)
    source_s : (S,)
    sources : (S, P)
        Delay and filter are searched by the first of them.
    """
    inside = (at_s >= source_s[0]) & (at_s <= source_s[-1])
    at_s, values = at_s[inside], values[inside]
    if len(at_s) < LEAST_ROWS or np.sum(np.diff(values) != 0) < LEAST_CHANGES:
        return None
    rows = _liveliest(values)
    period_s = _period_s(source_s)
    smoothed = {of_s: low_pass(sources[:, 0], of_s, period_s) for of_s in SMOOTHED_S}
    found = [
        _searched(_Trial(at_s[rows], values[rows], source_s, sources, sampled), smoothed)
        for sampled in ways(at_s, source_s)
    ]
    best = min((one for one in found if one is not None), key=lambda one: one[0], default=None)
    if best is None:
        return None
    _, delay_s, smoothed_s, sampled = best
    return _Trial(at_s, values, source_s, sources, sampled).fit(delay_s, smoothed_s)


@dataclass(frozen=True)
class _Fitted:
    """What one delay and filter explain of the changes, and the fit (P + 1, N) of the values."""

    of_changes: float
    design: FloatArray
    solution: FloatArray
    rounded: float


@dataclass(frozen=True)
class _Trial:
    at_s: FloatArray
    values: FloatArray
    source_s: FloatArray
    sources: FloatArray
    sampled: Sampled

    def columns(self, delay_s: float, smoothed_s: float) -> FloatArray:
        """The sources through the filter, at the stamps (N,) less the delay: (P, N)."""
        through = low_pass(self.sources, smoothed_s, self._source_period_s)
        return np.stack([self.sampled(self.at_s, delay_s, self.source_s, one) for one in through.T])

    def left(self, delay_s: float, smoothed_s: float) -> float:
        """Share of the squares of the changes that is left."""
        return 1 - self._fitted(delay_s, smoothed_s).of_changes

    def fit(self, delay_s: float, smoothed_s: float) -> Repetition:
        found = self._fitted(delay_s, smoothed_s)
        return Repetition(
            found.of_changes,
            _explained(self.values, found.solution @ found.design, found.rounded),
            delay_s,
            smoothed_s,
            found.solution[:-1],
            noise_of((1 - found.of_changes) * float(np.mean(self._changes**2))),
        )

    def _fitted(self, delay_s: float, smoothed_s: float) -> _Fitted:
        columns, changes = self.columns(delay_s, smoothed_s), self._changes
        of_columns = np.diff(columns, ORDER)[:, self._ordinary]
        design = np.vstack([columns, np.ones(len(self.values))])
        solution = least_squares(design, self.values)
        digits = np.append(solution[:-1] * self._digits, self._digit)
        rounded = float(np.sum(digits**2)) / 12
        left_of_changes = OF_NOISE * rounded
        if left_of_changes > ROUNDED * float(np.mean(changes**2)):
            rounded = left_of_changes = 0.0
        fitted = least_squares(of_columns, changes) @ of_columns
        return _Fitted(_explained(changes, fitted, left_of_changes), design, solution, rounded)

    @cached_property
    def _ordinary(self) -> BoolArray:
        """Changes (N - ORDER,) without the largest: a few steps of any drive are alike in all."""
        sizes = np.abs(np.diff(self.values, ORDER))
        return np.asarray(sizes <= np.quantile(sizes[sizes > 0], ORDINARY))

    @cached_property
    def _changes(self) -> FloatArray:
        """The ordinary ones of the values."""
        return np.asarray(np.diff(self.values, ORDER)[self._ordinary])

    @cached_property
    def _source_period_s(self) -> float:
        return _period_s(self.source_s)

    @cached_property
    def _digits(self) -> FloatArray:
        return np.array([digit_of(one) for one in self.sources.T])

    @cached_property
    def _digit(self) -> float:
        return digit_of(self.values)


def _period_s(stamps_s: FloatArray) -> float:
    return median(np.diff(stamps_s))


def noise_of(mean_square: float) -> float:
    """Standard deviation of a white noise whose changes have this mean square."""
    return float(np.sqrt(mean_square / OF_NOISE))


def _explained(values: FloatArray, fitted: FloatArray, rounded: float) -> float:
    """Share of the squares of values (N,); a variance by rounding is not counted as left."""
    left = max(float(np.mean((values - fitted) ** 2)) - rounded, 0.0)
    return 1 - left / max(float(np.mean(values**2)), 1e-300)


def _searched(
    trial: _Trial, smoothed: dict[float, FloatArray]
) -> tuple[float, float, float, Sampled] | None:
    """What is left, delay, time constant and way of sampling that explain most of the changes.

    The search begins with the first source smoothed by some time constants, (S,) each.
    """
    from scipy.optimize import minimize  # noqa: PLC0415 - slow to load

    period_s = _period_s(trial.at_s)
    starts = [(*_shift(trial, source, period_s), of_s) for of_s, source in smoothed.items()]
    alike, delay_s, smoothed_s = max(starts)
    if alike < LEAST_CORRELATION:
        return None
    start = (trial.left(delay_s, smoothed_s), delay_s, smoothed_s, trial.sampled)
    if start[0] < EXACT:
        return start
    steps = np.array([[0, 0], [period_s / 2, 0], [0, 0.03]])
    tried: list[float] = []

    def left(at: FloatArray) -> float:
        tried.append(trial.left(at[0], abs(at[1])))
        return tried[-1]

    def give_up(_: FloatArray) -> None:
        if len(tried) >= FEW and min(tried) > HOPELESS:
            raise StopIteration

    found = minimize(
        left,
        (delay_s, smoothed_s),
        method="Nelder-Mead",
        callback=give_up,
        options={"maxfev": REFINED, "initial_simplex": steps + np.array([delay_s, smoothed_s])},
    )
    refined = (float(found.fun), float(found.x[0]), float(abs(found.x[1])), trial.sampled)
    return min(start, refined, key=lambda one: one[0])


def _shift(trial: _Trial, source: FloatArray, period_s: float) -> tuple[float, float]:
    """Correlation of the changes with a source (S,) at the best whole row of delay, and that."""
    changes = np.diff(trial.values)
    of_source = np.diff(trial.sampled(trial.at_s, 0.0, trial.source_s, source))
    reach = min(max(round(MOST_DELAY_S / period_s), 1), len(changes))
    padded = np.zeros(len(changes) + 2 * reach)
    padded[reach:-reach] = changes
    size = float(np.sqrt((changes @ changes) * (of_source @ of_source)))
    products = np.abs(np.correlate(padded, of_source))
    best = int(np.argmax(products))
    return float(products[best]) / max(size, 1e-300), (best - reach) * period_s


def _liveliest(values: FloatArray) -> slice:
    """The stretch of MOST_ROWS in which the values change most."""
    if len(values) <= MOST_ROWS:
        return slice(None)
    summed = np.concatenate([[0.0], np.cumsum(np.diff(values) ** 2)])
    begin = int(np.argmax(summed[MOST_ROWS - 1 :] - summed[: -MOST_ROWS + 1]))
    return slice(begin, begin + MOST_ROWS)


def digit_of(values: FloatArray) -> float:
    """The step to which values were rounded: the usual smallest distance of two of them."""
    steps = np.diff(np.unique(values))
    return float(np.quantile(steps, 0.02)) if len(steps) > 2 else 0.0
