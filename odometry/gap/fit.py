"""Fit effects, and what is uncertain of the base, to measured runs."""

from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np

from odometry.arrays import BoolArray, FloatArray
from odometry.effects.base import Base, Effect
from odometry.effects.corrected import Added
from odometry.gap.calibration import Calibration
from odometry.gap.measured import Measured
from odometry.gap.solve import Found, Solved, least_squares, with_jacobian

ITERATIONS = 12
SEARCHED = 2  # of several starts: the best ones
RIDGE = 1e-9
NOTHING = np.zeros(0, dtype=np.bool_)
DAMPINGS = (1e-6, 1e-3, 1e-1, 1.0, 10.0)
ROUNDING = 1e-9


@dataclass(frozen=True)
class Fitted:
    """Effects fitted to measured runs together with the base.

    Attributes
    ----------
    base : Base
        Its free parameters moved within what the calibration leaves open.
    effects : tuple of Added
    covariance : (Q, Q)
        Of the parameters of all effects, in order.
    chi_squared : (K,)
        Of each window, fitted.
    held_out : (K,)
        Of each window by a fit to the other folds.
    base_moved : float
        Chi-squared of the base's move away from its calibration.
    """

    base: Base
    effects: tuple[Added, ...]
    covariance: FloatArray
    chi_squared: FloatArray
    held_out: FloatArray
    base_moved: float

    @property
    def freedom(self) -> int:
        """Parameters of the effects."""
        return sum(len(added.values) for added in self.effects)


class Fitter:
    """Fits hypotheses to the same measured windows."""

    def __init__(self, calibration: Calibration, measured: Measured) -> None:
        self.calibration = calibration
        self.measured = measured
        self.count = len(calibration.uncertain.values)
        self.prior = (
            np.linalg.cholesky(calibration.information + RIDGE * np.eye(self.count)).T
            if self.count
            else np.empty((0, 0))
        )

    def fit(
        self, effects: Sequence[Effect], known: Sequence[Added] = (), *, pin_slow: bool = False
    ) -> Fitted:
        """Fit effects; `known` are values to start from, where slow ones stay if `pin_slow`."""
        started = {(a.effect.name, a.effect.form): a.values for a in known}
        fixed_starts = [started.get((e.name, e.form)) for e in effects]
        fresh = [i for i, start in enumerate(fixed_starts) if start is None]
        first = [
            e.starts(self.measured.scenes[0].inputs, self.calibration.base)[0] if s is None else s
            for e, s in zip(effects, fixed_starts, strict=True)
        ]
        options = [first]
        if fresh:
            place = fresh[-1]
            starts = effects[place].starts(self.measured.scenes[0].inputs, self.calibration.base)
            options = [[*first[:place], start, *first[place + 1 :]] for start in starts]
        pinned = [
            np.full(len(e.parameters), pin_slow and e.slow and s is not None)
            for e, s in zip(effects, fixed_starts, strict=True)
        ]
        return self._finished(
            effects, self._best(effects, options, np.concatenate([NOTHING, *pinned]))
        )

    def spread(self, fit: Fitted) -> float:
        """Chi-squared a degree of freedom."""
        return float(fit.chi_squared.sum()) / len(self.measured.window_of_row)

    def design(self, fit: Fitted) -> Solved:
        """Rows at a fit and their Jacobian (R, P): base first, then the effects in order."""
        base = replace(self.calibration.uncertain, base=fit.base).values
        values = np.concatenate([base, *(added.values for added in fit.effects)])
        effects = [added.effect for added in fit.effects]
        return self._derived(effects, Found(values, self._rows(effects, values)))

    def _best(
        self, effects: Sequence[Effect], options: list[list[FloatArray]], pinned: BoolArray
    ) -> Solved:
        base = self.calibration.uncertain.values
        none = np.zeros(len(base), dtype=np.bool_)
        starts = [np.concatenate([base, *option]) for option in options]
        if len(starts) > 1:
            held = np.concatenate([~none, pinned])
            tried = [self._search(effects, start, 1, held) for start in starts]
            order = np.argsort([one.cost for one in tried], kind="stable")[:SEARCHED]
            starts = [tried[i].values for i in order]
        held = np.concatenate([none, pinned])
        found = [self._search(effects, start, ITERATIONS, held) for start in starts]
        return self._derived(effects, min(found, key=lambda one: one.cost), held)

    def _search(
        self, effects: Sequence[Effect], start: FloatArray, iterations: int, held: BoolArray
    ) -> Found:
        if not len(start):
            return Found(start, self._rows(effects, start))
        bounds = _pinned(self._bounds(effects), start, held)
        scales = self._scales(effects)
        return least_squares(
            lambda values: self._rows(effects, values), start, scales, bounds, iterations
        )

    def _derived(
        self, effects: Sequence[Effect], found: Found, held: BoolArray | None = None
    ) -> Solved:
        if not len(found.values):
            return Solved(found.values, found.rows, np.empty((len(found.rows), 0)))
        bounds = self._bounds(effects)
        if held is not None:
            bounds = _pinned(bounds, found.values, held)
        return with_jacobian(
            lambda values: self._rows(effects, values), found, self._scales(effects), bounds
        )

    def _bounds(self, effects: Sequence[Effect]) -> tuple[FloatArray, FloatArray]:
        low, high = self.calibration.uncertain.bounds
        parameters = [p for e in effects for p in e.parameters]
        return (
            np.concatenate([low, [p.low for p in parameters]]),
            np.concatenate([high, [p.high for p in parameters]]),
        )

    def _scales(self, effects: Sequence[Effect]) -> FloatArray:
        base = self.calibration.uncertain.scales
        return np.concatenate([base, [p.scale for e in effects for p in e.parameters]])

    def _split(
        self, effects: Sequence[Effect], values: FloatArray
    ) -> tuple[Base, tuple[Added, ...]]:
        ends = self.count + np.cumsum([len(e.parameters) for e in effects])
        added = tuple(
            Added(effect, values[end - len(effect.parameters) : end])
            for effect, end in zip(effects, ends, strict=True)
        )
        return self.calibration.uncertain.at(values[: self.count]), added

    def _rows(self, effects: Sequence[Effect], values: FloatArray) -> FloatArray:
        """Rows of the windows, then those of what is known of the base and usual of effects."""
        base, added = self._split(effects, values)
        moved = values[: self.count] - self.calibration.uncertain.values
        unusual = [_unusual(one, self.calibration.base) for one in added]
        return np.concatenate([self.measured.rows(base, added), self.prior @ moved, *unusual])

    def _finished(self, effects: Sequence[Effect], solved: Solved) -> Fitted:
        base, added = self._split(effects, solved.values)
        rows = len(self.measured.window_of_row)
        normal = solved.jacobian.T @ solved.jacobian
        active = np.diag(normal) > 0
        inverse = np.zeros_like(normal)
        inverse[np.ix_(active, active)] = np.linalg.pinv(normal[np.ix_(active, active)])
        chi_squared = self.measured.by_window(solved.rows[:rows])
        spread = max(1.0, chi_squared.sum() / max(1, rows - len(solved.values)))
        return Fitted(
            base,
            added,
            spread * inverse[self.count :, self.count :],
            chi_squared,
            self._held_out(effects, solved),
            float(solved.rows[rows:] @ solved.rows[rows:]),
        )

    def _held_out(self, effects: Sequence[Effect], solved: Solved) -> FloatArray:
        """Chi-squared (K,) of each fold by the others' fit: one Newton step from the fit to all."""
        fold_of_row = self.measured.folds[self.measured.window_of_row]
        held_out = np.zeros(len(self.measured.folds))
        for fold in np.unique(self.measured.folds):
            out = np.zeros(len(solved.rows), dtype=np.bool_)
            out[: len(fold_of_row)] = fold_of_row == fold
            rows = self._without(effects, solved, out)
            judged = self.measured.by_window(rows[: len(fold_of_row)])
            held_out[self.measured.folds == fold] = judged[self.measured.folds == fold]
        return held_out

    def _without(self, effects: Sequence[Effect], solved: Solved, out: BoolArray) -> FloatArray:
        """All rows by a fit to those that are not `out`: a damped step that makes them fit."""
        own, others = solved.jacobian[out], solved.jacobian[~out]
        normal, gradient = others.T @ others, own.T @ solved.rows[out]
        cost = float(solved.rows[~out] @ solved.rows[~out])
        for damping in DAMPINGS:
            damped = normal + damping * np.diag(np.diag(normal)) + RIDGE * np.eye(len(normal))
            step = np.linalg.solve(damped, gradient)
            rows = self._rows(effects, np.clip(solved.values + step, *self._bounds(effects)))
            if rows[~out] @ rows[~out] <= cost + ROUNDING * max(1.0, float(cost)):
                return rows
        return solved.rows


def _unusual(added: Added, base: Base) -> FloatArray:
    centre, spread = added.effect.usual(base)
    return np.asarray((added.values - centre) / spread)


def _pinned(
    bounds: tuple[FloatArray, FloatArray], values: FloatArray, held: BoolArray
) -> tuple[FloatArray, FloatArray]:
    low, high = bounds
    return np.where(held, values, low), np.where(held, values, high)
