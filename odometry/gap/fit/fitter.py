"""Fit effects, and what is uncertain of the base, to measured runs."""

from collections.abc import Collection, Hashable, Sequence
from dataclasses import dataclass, replace

import numpy as np

from odometry.arrays import FloatArray
from odometry.effects.interface.base import Effect
from odometry.effects.interface.base_model import Base
from odometry.effects.interface.corrected import Added
from odometry.effects.unknown.residual import Residual
from odometry.gap.fit.hypothesis import Hypothesis, own_values
from odometry.gap.fit.least_cost import derived, least_cost
from odometry.gap.fit.left_out import held_out, left_out_loss
from odometry.gap.prepare.calibration import Calibration
from odometry.gap.prepare.measured import Measured
from odometry.gap.prepare.responses import Responses, columns_of, simulated_scenes
from odometry.gap.solve import Found, Solved

WITHIN_95 = 1.96  # standard deviations


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
        Chi-squared of the base's move away from its calibration, and of unusual effects.
    base_alone : float
        Of the base's move alone.
    """

    base: Base
    effects: tuple[Added, ...]
    covariance: FloatArray
    chi_squared: FloatArray
    held_out: FloatArray
    base_moved: float
    base_alone: float = 0.0

    @property
    def freedom(self) -> int:
        """Parameters of the effects, those of the same physics once, and what else was searched."""
        own = own_values([added.effect for added in self.effects])
        return sum(
            len(one.values) * is_own + one.effect.searched
            for one, is_own in zip(self.effects, own, strict=True)
        )

    @property
    def cost(self) -> float:
        """Held-out chi-squared, and what the base had to move for it."""
        return float(self.held_out.sum()) + self.base_moved


class Fitter:
    """Fits hypotheses to the same measured windows, each once."""

    def __init__(self, calibration: Calibration, measured: Measured) -> None:
        self.calibration = calibration
        self.measured = measured
        self._fits: dict[tuple[Hashable, ...], tuple[tuple[Effect, ...], Fitted]] = {}

    def fit(
        self, effects: Sequence[Effect], known: Sequence[Added] = (), *, pin_slow: bool = False
    ) -> Fitted:
        """Fit effects; `known` are values to start from, where slow ones stay if `pin_slow`."""
        starts = ((id(added.effect), added.values.tobytes()) for added in known)
        asked = (*map(id, effects), pin_slow, *starts)
        if asked not in self._fits:
            named = (*effects, *(added.effect for added in known))  # kept: an id is of what lives
            self._fits[asked] = named, self._fitted(effects, known, pin_slow)
        return self._fits[asked][1]

    def _fitted(self, effects: Sequence[Effect], known: Sequence[Added], pin_slow: bool) -> Fitted:
        hypothesis = Hypothesis(self.calibration, self.measured, tuple(effects))
        started = {added.effect.key: added.values for added in known}
        known_starts = [started.get(effect.key) for effect in effects]
        pinned = [
            np.full(len(e.parameters), pin_slow and e.slow and start is not None)
            for e, start in zip(effects, known_starts, strict=True)
        ]
        of_base = np.zeros(hypothesis.of_base, dtype=np.bool_)
        held = hypothesis.held(np.concatenate([of_base, *pinned]))
        starts = hypothesis.distinct(self._starts(effects, known_starts))
        settled = [
            np.full(len(e.parameters), start is not None)
            for e, start in zip(effects, known_starts, strict=True)
        ]
        found = least_cost(hypothesis, starts, held, np.concatenate([of_base, *settled]))
        return _finished(hypothesis, derived(hypothesis, found, held))

    def spread(self, fit: Fitted) -> float:
        """Chi-squared a degree of freedom."""
        return float(fit.chi_squared.sum()) / self.measured.expected

    def spread_of(self, fit: Fitted) -> float:
        """Chi-squared a degree of freedom of a fit to the same windows, of more or fewer poses."""
        rows = self.measured.rows(fit.base, fit.effects)
        return float(rows @ rows) / self.measured.expected

    def by_piece(self, of_windows: FloatArray) -> FloatArray:
        """Sums (P,) over the pieces of the runs of what windows (K,) have."""
        _, piece = np.unique(self.measured.pieces, return_inverse=True)
        return np.asarray(np.bincount(piece, weights=of_windows))

    def design(self, fit: Fitted) -> Solved:
        """Rows at a fit and their Jacobian (R, P): base first, then the effects in order."""
        base = replace(self.calibration.uncertain, base=fit.base).values
        values = np.concatenate([base, *(added.values for added in fit.effects)])
        effects = tuple(added.effect for added in fit.effects)
        hypothesis = Hypothesis(self.calibration, self.measured, effects)
        nothing = np.zeros(len(values), dtype=np.bool_)
        return derived(hypothesis, Found(values, hypothesis.rows(values)), nothing)

    def rise_without(self, fit: Fitted, place: int, names: Collection[str]) -> float:
        """By how much chi-squared rises where some parameters of one effect do nothing.

        All others are fitted anew.
        """
        effects = tuple(added.effect for added in fit.effects)
        hypothesis = Hypothesis(self.calibration, self.measured, effects)
        base = replace(self.calibration.uncertain, base=fit.base).values
        pinned, values = [np.zeros(len(base), dtype=np.bool_)], [base]
        for number, added in enumerate(fit.effects):
            parameters = added.effect.parameters
            own = np.array(
                [number == place and p.name in names for p in parameters], dtype=np.bool_
            )
            absent = [0.0 if p.absent is None else p.absent for p in parameters]
            pinned.append(own)
            values.append(np.where(own, absent, added.values))
        held = hypothesis.held(np.concatenate(pinned))
        start = np.concatenate(values)
        found = least_cost(hypothesis, [start], held, np.ones(len(start), dtype=np.bool_))
        return found.cost - float(fit.chi_squared.sum()) - fit.base_moved

    def linear_losses(self, fit: Fitted, candidates: Sequence[Residual]) -> FloatArray:
        """Chi-squared (C,) that each candidate leaves on windows not fitted, to first order.

        Of each fold by least squares on the others, beside the base and the effects of a fit.
        """
        design = self.design(fit)
        simulated = simulated_scenes(fit.base, fit.effects, self.measured.scenes)
        return np.array([self._linear_loss(simulated, design, one) for one in candidates])

    def _linear_loss(
        self, simulated: Sequence[Responses], design: Solved, candidate: Residual
    ) -> float:
        own = columns_of(candidate, simulated, self.measured.whiteners)
        own = np.pad(own, ((0, len(design.rows) - len(own)), (0, 0)))
        jacobian, rows = np.hstack([design.jacobian, own]), design.rows
        _, spread = candidate.usual(self.calibration.base)
        if np.isfinite(spread).any():
            known = np.pad(np.diag(1 / spread), ((0, 0), (design.jacobian.shape[1], 0)))
            jacobian = np.concatenate([jacobian, known])
            rows = np.concatenate([rows, np.zeros(len(known))])
        return left_out_loss(jacobian, rows, self.measured)

    def _starts(
        self, effects: Sequence[Effect], known: Sequence[FloatArray | None]
    ) -> list[FloatArray]:
        """Values (V,) to start from: several where the last effect that is new has several."""
        inputs, base = self.measured.scenes[0].inputs, self.calibration.base
        offered = [
            e.starts(inputs, base) if start is None else start[None]
            for e, start in zip(effects, known, strict=True)
        ]
        fresh = [place for place, start in enumerate(known) if start is None]
        count = len(offered[fresh[-1]]) if fresh else 1
        chosen = [
            [of[i if fresh and place == fresh[-1] else 0] for place, of in enumerate(offered)]
            for i in range(count)
        ]
        return [np.concatenate([self.calibration.uncertain.values, *one]) for one in chosen]


def _finished(hypothesis: Hypothesis, solved: Solved) -> Fitted:
    measured = hypothesis.measured
    base, added = hypothesis.split(solved.values)
    rows = len(measured.window_of_row)
    normal = solved.jacobian.T @ solved.jacobian
    active = np.diag(normal) > 0
    inverse = np.zeros_like(normal)
    inverse[np.ix_(active, active)] = np.linalg.pinv(normal[np.ix_(active, active)])
    chi_squared = measured.by_window(solved.rows[:rows])
    of_effects = hypothesis.places[hypothesis.of_base :]
    freedom = max(1.0, measured.expected - len(np.unique(hypothesis.places)))
    spread = max(1.0, chi_squared.sum() / freedom)
    return Fitted(
        base,
        added,
        spread * inverse[np.ix_(of_effects, of_effects)] + np.diag(_resolved(hypothesis, added)),
        chi_squared,
        held_out(hypothesis, solved),
        float(solved.rows[rows:] @ solved.rows[rows:]),
        float(np.sum(solved.rows[rows : rows + hypothesis.of_base] ** 2)),
    )


def _resolved(hypothesis: Hypothesis, effects: Sequence[Added]) -> FloatArray:
    """Variance (Q,) of values in steps, of which any between two steps does the same."""
    of_scenes = [
        np.concatenate(
            [np.empty(0), *(e.effect.resolution(e.values, scene.inputs) for e in effects)]
        )
        for scene in hypothesis.measured.scenes
    ]
    return np.asarray((np.min(of_scenes, axis=0) / WITHIN_95) ** 2)
