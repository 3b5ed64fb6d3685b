"""A hypothesis: which effects are there, as a least-squares problem in their and the base's values.

Values are in one array: what is uncertain of the base first, then the effects in order. Effects of
the same physics have the values of the first of them.
"""

from collections.abc import Sequence
from dataclasses import dataclass
from functools import cached_property

import numpy as np

from odometry.arrays import BoolArray, FloatArray, IntArray
from odometry.effects.interface.base import Effect, EffectParameter
from odometry.effects.interface.base_model import Base
from odometry.effects.interface.corrected import Added
from odometry.gap.prepare.calibration import Calibration
from odometry.gap.prepare.derivative import whitened_changes, whitened_derivative
from odometry.gap.prepare.measured import Measured
from odometry.gap.solve import (
    Bounds,
    RowsAt,
    steps_within,
)

RIDGE = 1e-9
TOGETHER = 8  # starts


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
        return np.concatenate([self.measured.rows(base, added), self._known_rows(values, added)])

    def rows_of_each(self, values: Sequence[FloatArray]) -> FloatArray:
        """The same (C, R) at several values (V,)."""
        models = [self.split(each) for each in values]
        known = [
            self._known_rows(each, added) for each, (_, added) in zip(values, models, strict=True)
        ]
        return np.hstack([self.measured.rows_of_each(models), np.stack(known)])

    def costs(self, values: Sequence[FloatArray]) -> FloatArray:
        """Chi-squared (C,) at several values (V,); infinite where it is not known."""
        costs = (self.rows_of_each(values) ** 2).sum(axis=-1)
        return np.asarray(np.nan_to_num(costs, nan=np.inf))

    def _known_rows(self, values: FloatArray, added: Sequence[Added]) -> FloatArray:
        moved = values[: self.of_base] - self.calibration.uncertain.values
        own = zip(added, own_values(self.effects), strict=True)
        unusual = [_unusual(one, self.calibration.base) for one, is_own in own if is_own]
        return np.concatenate([self._prior @ moved, *unusual])

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
        jacobian = whitened_derivative(
            self.split,
            values,
            steps,
            measured.scenes,
            measured.whiteners,
            more=len(self._known),
        )
        jacobian[len(rows) - len(self._known) :, steps != 0] = self._known[:, steps != 0]
        return jacobian

    def first_order_costs(self, starts: Sequence[FloatArray], held: BoolArray) -> FloatArray:
        """Chi-squared (S,) that a step from each of several starts leaves, to first order.

        The starts (V,) do the same: they differ in values that shape what is not there yet.
        """
        rows, measured = self.rows(starts[0]), self.measured
        here, count = self.split(starts[0]), len(measured.window_of_row)
        free = np.flatnonzero(~(held | self.shapes))
        steps = steps_within(starts[0], self.scales, self.bounds)
        costs = []
        for begin in range(0, len(starts), TOGETHER):
            others = [
                (self.split(np.where(np.arange(len(start)) == place, start + steps, start)), step)
                for start in starts[begin : begin + TOGETHER]
                for place, step in zip(free, steps[free], strict=True)
            ]
            columns = whitened_changes(here, others, measured.scenes, measured.whiteners)
            for own in columns.reshape(-1, len(free), count):
                gradient = own @ rows[:count]
                solved = np.linalg.lstsq(own @ own.T, gradient, rcond=None)[0]
                costs.append(float(rows @ rows - gradient @ solved))
        return np.array(costs)

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
