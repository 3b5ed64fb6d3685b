"""What has no name, searched further: by functions that are no rivals of names.

A residual is no name. Here names are decided already, so that more may be tried, and what few
held-out stretches leave open may be decided with the stretches measured, each of which was
evaluated by a fit to the others.
"""

from collections.abc import Sequence
from dataclasses import dataclass, field, replace
from functools import cached_property

import numpy as np

from odometry.arrays import FloatArray
from odometry.effects.interface.base import Effect
from odometry.effects.interface.base_model import Base
from odometry.effects.interface.corrected import Added
from odometry.effects.measurement.late_by_chance import LateByChance
from odometry.effects.unknown.leaning import LEANING
from odometry.effects.unknown.residual import TREADS, Residual
from odometry.effects.unknown.residual_variables import FURTHER, OF_TREADS, REPEATED, variable_of
from odometry.gap.config import GapConfig
from odometry.gap.fit.own_moments import with_own_moments
from odometry.gap.name.accepted_effects import Standing
from odometry.gap.name.explanation import Explanation
from odometry.gap.name.general import every, knots_of
from odometry.gap.name.places import finer_maps
from odometry.gap.name.unnamed import grown_of, with_course
from odometry.gap.name.verdict import MAY_BE_CHANCE, raises_measured, within_noise
from odometry.gap.prepare.pieces import numbered_pieces
from odometry.gap.prepare.simulate import whitened_residuals
from odometry.gap.prepare.statistic import sure_sum
from odometry.windows.dense.dense import DenseWindows
from odometry.windows.dense.dense_noise import whitening

FEW = 4  # stretches held out


@dataclass
class Further(Standing):
    """Keeps in `sure_with_measured` what few held-out stretches alone do not decide."""

    sure_with_measured: list[Explanation] = field(default_factory=list)

    def further(self, found: Explanation) -> Explanation:
        """The explanation without a name that costs least on the measured runs; a name as it is.

        Each must close some of the gap on held-out data, surely: by itself or, where that closes
        half, together with the stretches measured; and more of it than what there was.
        """
        is_closed = found.steps or found.base_closes
        share = self._held_out_left(found)[1] if is_closed else 0.0
        is_there = found.steps or found.unexplained or self.is_above
        if found.has_name or not is_there or share >= 1.0:
            return found
        options = [
            one
            for one in (*self._tried_in_turn(found), *self.sure_with_measured)
            if one.steps and self._held_out_left(one)[1] > share
        ]
        best = min([found, *options], key=lambda one: one.fitted.cost)
        if best is found:
            return found
        return replace(found, steps=best.steps, unexplained=False, base_closes=False)

    def _tried_in_turn(self, found: Explanation) -> list[Explanation]:
        """Explanations that hold: where none does, without the variable that was the first."""
        candidates = (
            *self.small_functions,
            *further_candidates(
                self.fitter.measured.scenes, self.fitter.calibration.base, self.config
            ),
        )
        held = replace(found, steps=())
        for _ in range(self.config.tries_further):
            grown = grown_of(self, found, candidates, self.config.promising_further)
            held = self._standing(grown, ())
            if held.steps or self.sure_with_measured or not grown.steps:
                break
            tried = {one.variable for one in grown.effects[:1] if isinstance(one, Residual)}
            candidates = tuple(one for one in candidates if one.variable not in tried)
        return [self._standing(with_course(self, held), ())]

    def _fails(self, found: Explanation) -> str:
        """See `Standing`; names that last, and what is unknown, by the stretches measured as well.

        Of four stretches held out or fewer hardly any gain is sure. Names must close more.
        """
        reason = super()._fails(found)
        if (
            reason
            and not found.has_name
            and self._is_sure_with_measured(found, self.config.least_of_rest)
        ):
            self.sure_with_measured.append(found)
        by_few = reason.endswith(MAY_BE_CHANCE) and self._is_held_out_by_few
        stands = (
            by_few
            and all(map(_lasts, found.effects))
            and self._is_sure_with_measured(found, self.config.mostly_closed)
        )
        return "" if stands else reason

    @cached_property
    def _is_held_out_by_few(self) -> bool:
        return len(np.unique(numbered_pieces(self.held_out, self.config.part_s))) <= FEW

    def _is_sure_with_measured(self, found: Explanation, share: float) -> bool:
        """Whether it closes a share of the gap held out, and some of all stretches, surely.

        Gains are of chi-squared: of measured stretches by fits to the others.
        """
        if (
            self._held_out_left(found)[1] < share
            or within_noise(self._at_first(self.held_out), self.config)
            or raises_measured(self._believed_gap(), self._gap(found.fitted), self.floor.measure)
        ):
            return False
        fit, scenes = found.fitted, self.fitter.measured.scenes
        believed = self.fitter.calibration
        effects, held_out = with_own_moments(fit.base, fit.effects, self.held_out, scenes, believed)
        before, after = (
            self._by_piece(base, of, held_out)
            for base, of in ((believed.base, ()), (fit.base, effects))
        )
        measured = self.fitter.by_piece(self.start.held_out - fit.held_out)
        return sure_sum(np.concatenate([measured, before - after]), self.config.trimmed) > 0

    def _by_piece(
        self, base: Base, effects: Sequence[Added], scenes: Sequence[DenseWindows]
    ) -> FloatArray:
        """Chi-squared (P,) of the pieces of runs."""
        whiteners = [whitening(scene, self.fitter.calibration.noise) for scene in scenes]
        squares = whitened_residuals(base, effects, scenes, whiteners) ** 2
        _, piece = np.unique(numbered_pieces(scenes, self.config.part_s), return_inverse=True)
        rows = np.concatenate([np.full(len(s), s.rows_per_window) for s in scenes])
        of_pieces = np.bincount(np.repeat(piece, rows), weights=squares)
        return np.asarray(of_pieces, dtype=np.float64)


def _lasts(effect: Effect) -> bool:
    """Whether it is a name that acts all the time, and no fault of the reference."""
    by_chance = isinstance(effect, Residual) or effect.name == LateByChance.name
    return not (by_chance or effect.course)


def further_candidates(
    scenes: Sequence[DenseWindows], base: Base, config: GapConfig
) -> tuple[Residual, ...]:
    """Of speed that treads lost or gained or repeat, of turns since, of leaning; and fine maps."""
    found: list[Residual] = []
    twists = [base.model.twist(base.values, scene.inputs) for scene in scenes]
    for name in FURTHER:
        of_scenes = [variable_of(name, s.inputs, t) for s, t in zip(scenes, twists, strict=True)]
        known = [np.ravel(values) for values in of_scenes if values is not None]
        knots = knots_of(np.concatenate(known), name, config) if len(known) == len(scenes) else ()
        found += _of_knots(name, knots) if knots else []
    return (*found, *finer_maps(scenes, config))


def _of_knots(name: str, knots: tuple[float, ...]) -> list[Residual]:
    """A share of the turn, what leans, or what is added to each tread, to both or to one."""
    if name in LEANING:  # nothing at zero
        along = ("v_x", "v_y")[LEANING.index(name)]
        return [Residual(name, ((along, 0), (along, len(knots) - 1)), "", knots)]
    if name not in OF_TREADS:
        return [Residual(name, every(("omega",), len(knots)), "omega", knots)]
    found = []
    for treads in (TREADS, *((tread,) for tread in TREADS)):
        terms = every(treads, len(knots))
        if name == REPEATED:  # nothing where no speed is repeated
            found.append(Residual(name, tuple(t for t in terms if knots[t[1]]), "", knots))
        else:
            found += [Residual(name, terms, by, knots) for by in ("", "speed")]
    return found
