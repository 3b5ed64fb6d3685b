"""A hypothesis: which effects are there, as a least-squares problem in their and the base's values.

Values are in one array: what is uncertain of the base first, then the effects in order. Effects of
the same physics have the values of the first of them.
"""

from collections.abc import Sequence
from dataclasses import dataclass
from functools import cached_property

import numpy as np

from odometry.arrays import BoolArray, FloatArray, IntArray
from odometry.effects.base import Effect, EffectParameter
from odometry.effects.base_model import Base
from odometry.effects.corrected import Added
from odometry.gap.prepare.calibration import Calibration
from odometry.gap.prepare.derivative import whitened_derivative
from odometry.gap.prepare.measured import Measured
from odometry.gap.solve import (
    Bounds,
    Found,
    RowsAt,
    Solved,
    least_squares,
    steps_within,
    with_jacobian,
)

RIDGE = 1e-9
ITERATIONS = 12
MOST_STARTS = 2  # from which values in steps are searched
SEARCHED = 2  # of several starts: the best ones
JUMPS = (-4.0, -2.0, -1.0, -0.5, 0.5, 1.0, 2.0, 4.0)  # in scales of a parameter
MOST_JUMPS = 4


@dataclass(frozen=True)
class Hypothesis:
    """Effects beside a base that may move within its calibration."""

    calibration: Calibration
    measured: Measured
    effects: tuple[Effect, ...]

    @property
    def of_base(self) -> int:
        """How many of the values are those of the base."""
        return len(self.calibration.uncertain.values)

    @cached_property
    def parameters(self) -> tuple[EffectParameter, ...]:
        """Of all effects."""
        return tuple(p for effect in self.effects for p in effect.parameters)

    @cached_property
    def bounds(self) -> tuple[FloatArray, FloatArray]:
        """Least and largest values (V,)."""
        low, high = self.calibration.uncertain.bounds
        return (
            np.concatenate([low, [p.low for p in self.parameters]]),
            np.concatenate([high, [p.high for p in self.parameters]]),
        )

    @cached_property
    def scales(self) -> FloatArray:
        """Small changes (V,) that matter."""
        base = self.calibration.uncertain.scales
        return np.concatenate([base, [p.scale for p in self.parameters]])

    @cached_property
    def shapes(self) -> BoolArray:
        """Values (V,) that shape an effect, which may change by steps as they change."""
        return self._of_effects(
            [p.absent is None and not e.slow for e in self.effects for p in e.parameters]
        )

    @cached_property
    def in_steps(self) -> BoolArray:
        """Values (V,) of effects that change in steps as they change."""
        return self._of_effects([p.in_steps for p in self.parameters])

    def _of_effects(self, of: Sequence[bool]) -> BoolArray:
        return np.array([*[False] * self.of_base, *of], dtype=np.bool_)

    @cached_property
    def places(self) -> IntArray:
        """Where (V,) each value is: in its own place, or in that of an effect of its physics."""
        places = np.arange(self.of_base + len(self.parameters))
        first: dict[str, IntArray] = {}
        for effect, end in zip(self.effects, self._ends, strict=True):
            own = np.arange(end - len(effect.parameters), end)
            places[own] = first.setdefault(effect.physics, own) if effect.physics else own
        return places

    def held(self, pinned: BoolArray) -> BoolArray:
        """Which values (V,) a search holds: what is elsewhere, and what is pinned wherever used."""
        free = np.zeros(len(pinned), dtype=np.bool_)
        np.logical_or.at(free, self.places, ~pinned)
        return ~free

    def distinct(self, starts: Sequence[FloatArray]) -> list[FloatArray]:
        """Those values (V,) that differ where they are used."""
        return list({start[self.places].tobytes(): start for start in starts}.values())

    @cached_property
    def _ends(self) -> IntArray:
        return self.of_base + np.cumsum([len(e.parameters) for e in self.effects], dtype=np.int64)

    def split(self, values: FloatArray) -> tuple[Base, tuple[Added, ...]]:
        """The base and the effects at values (V,)."""
        values = values[self.places]
        added = tuple(
            Added(effect, values[end - len(effect.parameters) : end])
            for effect, end in zip(self.effects, self._ends, strict=True)
        )
        return self.calibration.uncertain.at(values[: self.of_base]), added

    def elsewhere(self, values: FloatArray) -> list[FloatArray]:
        """Values (V,) with those of one effect where its search may go on from."""
        found = []
        for effect, end in zip(self.effects, self._ends, strict=True):
            own = slice(end - len(effect.parameters), end)
            for there in effect.elsewhere(values[own]):
                found.append(values.copy())
                found[-1][own] = there
        return found

    def rows(self, values: FloatArray) -> FloatArray:
        """Rows of the windows, then those of what is known of the base and usual of effects."""
        base, added = self.split(values)
        moved = values[: self.of_base] - self.calibration.uncertain.values
        own = zip(added, own_values(self.effects), strict=True)
        unusual = [_unusual(one, self.calibration.base) for one, is_own in own if is_own]
        return np.concatenate([self.measured.rows(base, added), self._prior @ moved, *unusual])

    def derivative(
        self,
        rows_at: RowsAt,  # noqa: ARG002 - of the interface
        values: FloatArray,
        rows: FloatArray,
        scales: FloatArray,
        bounds: Bounds,
    ) -> FloatArray:
        """Derivative (R, V) of `rows` by the values; see `odometry.gap.solve.differences`."""
        steps, measured = steps_within(values, scales, bounds), self.measured
        of_windows = whitened_derivative(
            self.split, values, steps, measured.scenes, measured.whiteners
        )
        jacobian = np.zeros((len(values), len(rows))).T
        jacobian[: len(of_windows)] = of_windows
        jacobian[len(of_windows) :, steps != 0] = self._known[:, steps != 0]
        return jacobian

    @cached_property
    def _known(self) -> FloatArray:
        """Derivative of the rows that follow those of the windows, by all values."""
        count = self.of_base
        known = [np.pad(self._prior, ((0, 0), (0, len(self.parameters))))]
        own = zip(self.effects, own_values(self.effects), self._ends, strict=True)
        for effect, is_own, end in own:
            if is_own:
                _, spread = effect.usual(self.calibration.base)
                places = np.arange(end - len(spread), end)
                known.append(np.eye(count + len(self.parameters))[places] / spread[:, None])
        return np.concatenate(known)

    @cached_property
    def _prior(self) -> FloatArray:
        """Square root of the calibration's information, that of (F, F)."""
        if not self.of_base:
            return np.empty((0, 0))
        information = self.calibration.information + RIDGE * np.eye(self.of_base)
        return np.asarray(np.linalg.cholesky(information).T)


def own_values(effects: Sequence[Effect]) -> tuple[bool, ...]:
    """Whether each effect has its own values: none before it is of the same physics."""
    before = [{one.physics for one in effects[:place]} for place in range(len(effects))]
    return tuple(
        not effect.physics or effect.physics not in earlier
        for effect, earlier in zip(effects, before, strict=True)
    )


def _unusual(added: Added, base: Base) -> FloatArray:
    centre, spread = added.effect.usual(base)
    return np.asarray((added.values - centre) / spread)


def least_cost(
    hypothesis: Hypothesis, starts: list[FloatArray], held: BoolArray, settled: BoolArray
) -> Found:
    """Values of least cost from several starts, the held ones as they are.

    From those that are `settled` (V,), by an earlier search, none in steps jumps.
    """
    in_steps = hypothesis.in_steps & ~settled
    if in_steps.any():
        starts = _cheapest(hypothesis, starts)
    if len(starts) > 1:
        base_held = held | (np.arange(len(held)) < hypothesis.of_base)
        tried = [_search(hypothesis, start, 1, base_held) for start in starts]
        order = np.argsort([one.cost for one in tried], kind="stable")[:SEARCHED]
        starts = [tried[i].values for i in order]
    found = [_search(hypothesis, start, ITERATIONS, held) for start in starts]
    jumps = hypothesis.shapes | in_steps
    return _after_jumps(hypothesis, min(found, key=lambda one: one.cost), held, jumps)


def _cheapest(hypothesis: Hypothesis, starts: list[FloatArray]) -> list[FloatArray]:
    """The starts of least cost as they are: values in steps hardly move in one step of a search."""
    costs = [np.sum(hypothesis.rows(start) ** 2) for start in starts]
    order = np.argsort(np.nan_to_num(costs, nan=np.inf), kind="stable")
    return [starts[i] for i in order[:MOST_STARTS]]


def _search(hypothesis: Hypothesis, start: FloatArray, iterations: int, held: BoolArray) -> Found:
    if not len(start):
        return Found(start, hypothesis.rows(start))
    bounds = _pinned(hypothesis.bounds, start, held)
    return least_squares(
        hypothesis.rows,
        start,
        hypothesis.scales,
        bounds,
        iterations,
        derivative=hypothesis.derivative,
    )


def _after_jumps(hypothesis: Hypothesis, found: Found, held: BoolArray, jumps: BoolArray) -> Found:
    """Search on from jumps of the values whose derivatives are small, and from elsewhere."""
    places = np.flatnonzero(jumps & ~held)
    unit = np.diag(hypothesis.scales)
    steps = [jump * unit[place] for place in places for jump in JUMPS]
    for _ in range(MOST_JUMPS if steps else 0):
        tried = [np.clip(found.values + step, *hypothesis.bounds) for step in steps]
        tried += [np.where(held, found.values, v) for v in hypothesis.elsewhere(found.values)]
        costs = np.nan_to_num([np.sum(hypothesis.rows(v) ** 2) for v in tried], nan=np.inf)
        if costs.min() > found.cost - 1:
            break
        found = _search(hypothesis, tried[int(np.argmin(costs))], ITERATIONS, held)
    return found


def derived(hypothesis: Hypothesis, found: Found, held: BoolArray) -> Solved:
    """Rows at the values found, and their Jacobian; zero for what is held."""
    if not len(found.values):
        return Solved(found.values, found.rows, np.empty((len(found.rows), 0)))
    bounds = _pinned(hypothesis.bounds, found.values, held)
    return with_jacobian(
        hypothesis.rows, found, hypothesis.scales, bounds, derivative=hypothesis.derivative
    )


def _pinned(
    bounds: tuple[FloatArray, FloatArray], values: FloatArray, held: BoolArray
) -> tuple[FloatArray, FloatArray]:
    low, high = bounds
    return np.where(held, values, low), np.where(held, values, high)
