"""Effects added one by one, each evaluated on held-out windows."""

from collections.abc import Callable, Sequence
from dataclasses import dataclass, field, replace
from functools import cached_property

import numpy as np

from odometry.effects.interface.base import Effect
from odometry.effects.unknown.residual import Residual
from odometry.gap.config import GapConfig
from odometry.gap.fit.contest import Judged, judge, ranked
from odometry.gap.fit.effect_values import is_the_effect
from odometry.gap.fit.fitter import Fitted, Fitter
from odometry.gap.fit.sparse import sparse_residual
from odometry.gap.name.candidates import contact_effects, of_the_same_robot
from odometry.gap.name.explanation import Explanation
from odometry.gap.name.form_gates import is_resolved, is_unbeaten
from odometry.gap.name.general import general_candidates, single_candidates
from odometry.gap.name.in_calibration import spoils_calibration
from odometry.gap.name.verdict import Refusal, base_left_calibration, closes_held_out
from odometry.gap.prepare.statistic import Gap, gap_of, root_mean_square
from odometry.windows.dense.dense import DenseWindows


@dataclass
class Search:
    """Adds effects one by one where they pay.

    `floor` and `held_floor` are of the measure by which all is judged. `without_essence` are names
    that were refused as they close the same without what makes them these effects.
    """

    fitter: Fitter
    start: Fitted
    held_out: Sequence[DenseWindows]
    floor: Gap
    held_floor: Gap
    config: GapConfig
    progress: Callable[[], None]
    refusals: dict[str, Refusal] = field(default_factory=dict)
    without_essence: set[str] = field(default_factory=set)

    @cached_property
    def small_functions(self) -> tuple[Residual, ...]:
        """Smooth functions of one variable, the same each time: a fit is done once."""
        scenes, base = self.fitter.measured.scenes, self.fitter.calibration.base
        return (
            *single_candidates(scenes, base, self.config),
            *general_candidates(scenes, base, self.config),
        )

    def stepwise(
        self, candidates: Sequence[Effect], begun: Explanation | None = None
    ) -> Explanation:
        """Add the candidate of most evidence until none earns a name."""
        found = begun or Explanation(self.start, (), ())
        while len(found.steps) < self.config.most_effects:
            before = found.fitted
            if found.steps and not self.has_excess(before):
                break
            judged = self._judged(before, _beside(found, candidates))
            found = replace(found, first=found.first or tuple(judged))
            best = self.best_earner(judged, before)
            if best is None:
                break
            contests = {**found.contests, best.effect.name: tuple(judged)}
            step = self._all_free(best, before)
            found = replace(found, steps=(*found.steps, step), contests=contests)
        return found

    def in_order(self, found: Explanation, effects: Sequence[Effect]) -> Explanation:
        """These effects, evaluated as they are added one by one."""
        steps: tuple[Judged, ...] = ()
        for effect in effects:
            before = steps[-1].fitted if steps else self.start
            (one,) = judge(self.fitter, before, [effect], self.config, self.progress)
            steps = (*steps, self._all_free(one, before))
        return replace(found, steps=steps)

    def best_smooth(
        self, before: Fitted, candidates: Sequence[Residual], below: float = np.inf
    ) -> Judged | None:
        """The smooth function of most evidence, made sparse, if it earns its place.

        Those that leave more than `below` even with all their terms are not fitted.
        """
        if not candidates or not self.has_excess(before):
            return None
        losses = self.fitter.linear_losses(before, candidates)
        order = np.argsort(losses, kind="stable")[: self.config.promising]
        promising = [candidates[i] for i in order if losses[i] < below]
        judged = judge(self.fitter, before, promising, self.config, self.progress)
        sparse = [sparse_residual(self.fitter, one.fitted) for one in judged]
        again = judge(self.fitter, before, sparse, self.config, self.progress)
        return self.best_earner(again, before) or self.best_earner(judged, before)

    def refuse(self, effect: Effect, reason: str) -> None:
        """Remember the first reason for which a name does not stand."""
        self.refusals.setdefault(effect.name, Refusal(effect.name, effect.form, reason))

    def _judged(self, before: Fitted, candidates: Sequence[Effect]) -> list[Judged]:
        """The quick forms, and those of contact forces where an effect leaves something."""
        judged = judge(self.fitter, before, candidates, self.config, self.progress)
        best = self.best_earner(judged, before) or self._reference_first(judged, before)
        found = before if best is None else best.fitted
        if not found.effects or self.fitter.spread(found) < self.config.contact_spread:
            return judged
        taken = {added.effect.name for added in before.effects}
        contacts = [e for e in self._contacts if e.name not in taken]
        slow = of_the_same_robot(contacts, [added.effect for added in before.effects])
        more = judge(self.fitter, before, slow, self.config, self.progress)
        fits = [one.fitted for one in (*judged, *filter(self._holds_in_calibration, more))]
        return ranked(self.fitter, before, fits, self.config)

    def _holds_in_calibration(self, one: Judged) -> bool:
        """Whether an effect that acts in every drive does so in the calibration runs."""
        added, calibration = one.fitted.effects[-1], self.fitter.calibration
        gain = one.gain / self.fitter.measured.expected
        reason = spoils_calibration(added, gain, calibration, self.config)
        if reason:
            self.refuse(one.effect, reason)
        return not reason

    @cached_property
    def _contacts(self) -> tuple[Effect, ...]:
        return contact_effects(self.fitter.measured.scenes, self.fitter.calibration)

    def _reference_first(self, judged: Sequence[Judged], before: Fitted) -> Judged | None:
        """The first that pays, if it is a fault of the reference: motion may do it as well."""
        best = next((one for one in judged if self.pays(one, before)), None)
        return best if best is not None and best.effect.of_reference else None

    def _all_free(self, one: Judged, before: Fitted) -> Judged:
        """The same with the parameters of slow effects, held in the contest, free again."""
        if not any(added.effect.slow for added in before.effects):
            return one
        effects = [added.effect for added in one.fitted.effects]
        fit = self.fitter.fit(effects, one.fitted.effects)
        return replace(ranked(self.fitter, before, [fit], self.config)[0], evidence=one.evidence)

    def spread_of(self, found: Explanation) -> float:
        """Chi-squared a degree of freedom that an explanation leaves, at least 1."""
        return max(1.0, self.fitter.spread(found.fitted))

    def has_excess(self, before: Fitted) -> bool:
        """Whether the gap is above the interval of the noise floor, or hidden in a moved base.

        Or, where what acts now and then shows on held-out data, chi-squared is beyond noise.
        """
        rarely = self.is_above and self.fitter.spread(before) > self.config.unexplained
        return rarely or self._gap(before) > self.floor.high or self._left(before)

    def _left(self, fit: Fitted) -> bool:
        """Whether the base left its calibration."""
        free = len(self.fitter.calibration.uncertain.values)
        return base_left_calibration(fit, free, self.config)

    def _brings_back(self, fit: Fitted, before: Fitted) -> bool:
        """Whether a base that had left its calibration is near it again."""
        near = fit.base_alone < self.config.brought_back * before.base_alone
        return near or not self._left(fit)

    def explains_move(self, fit: Fitted, before: Fitted) -> bool:
        """Whether nearly all of a base's move beyond its calibration is the effect's.

        Of a move that closes a gap on held-out data that is surely there: else chance made it.
        """
        near = fit.base_alone < self.config.brought_back * before.base_alone
        return near and self._left(before) and self.is_above and self.base_closes

    @cached_property
    def is_above(self) -> bool:
        """Whether the interval of the gap on held-out data lies above that of its noise floor."""
        base, part_s = self.fitter.calibration.base, self.config.part_s
        gap = gap_of(base, (), self.held_out, part_s, self.floor.measure)
        return gap.low > self.held_floor.high

    @cached_property
    def base_closes(self) -> bool:
        """Whether the base, moved beyond its calibration, closes held-out gap by itself."""
        believed = (self.fitter.calibration.base, ())
        moved = (self.start.base, ())
        return self._left(self.start) and not closes_held_out(
            believed, moved, self.held_out, self.held_floor, self.config
        )

    def _gap(self, fit: Fitted) -> float:
        scenes = self.fitter.measured.scenes
        return root_mean_square(fit.base, fit.effects, scenes, self.floor.measure)

    def best_earner(self, judged: Sequence[Judged], before: Fitted) -> Judged | None:
        """Of most evidence among those that earn a name, if none that is refused beats it."""
        refused: Judged | None = None
        for one in judged:
            if not self.pays(one, before):
                continue
            reason = is_the_effect(one.fitted, self.config) or is_resolved(
                one.fitted.effects[-1], before.effects, self.fitter.measured.scenes
            )
            beaten = "" if reason or refused is None else self._beaten(one, refused)
            if not reason and not beaten:
                return one
            self.refuse(one.effect, reason or beaten)
            if beaten:
                break
            refused = refused or one
        return None

    def _beaten(self, one: Judged, refused: Judged) -> str:
        margin = self.config.general_margin * max(1.0, self.fitter.spread(one.fitted))
        margin = max(margin, self.config.most_beaten * one.gain)
        return is_unbeaten(one.gain, refused.effect.name, refused.gain, margin)

    def pays(self, one: Judged, before: Fitted) -> bool:
        """Enough evidence, in more than one moment, and enough of the excess closed.

        The excess is that before any effect, of the gap above the noise floor or of chi-squared
        above what noise explains: a better heading counts as much as a better place.
        """
        if not self.has_excess(before) or one.least <= self.config.least_evidence:
            return False
        share = self.config.least_share if before.effects else self.config.first_share
        noise = self.fitter.measured.expected
        excess_of_gap = max(self._gap(self.start) - self.floor.value, 0.0)
        closed_of_gap = self._gap(before) - self._gap(one.fitted)
        excess = max(self.start.cost - noise, self.config.least_excess * noise)
        closed = before.cost - one.fitted.cost
        if before.effects and not isinstance(one.effect, Residual):
            share_of_rest = closed / max(before.cost - noise, self.config.least_excess * noise)
            if share_of_rest < self.config.least_rest:
                return False
        if self._gap(before) <= self.floor.high:
            if self.explains_move(one.fitted, before):
                return True
            if not self._brings_back(one.fitted, before):
                return False
        of_gap = closed_of_gap > share * excess_of_gap > 0
        return bool(of_gap or closed > share * excess)


def _beside(found: Explanation, candidates: Sequence[Effect]) -> list[Effect]:
    """Those that are no name yet, and that lowered the cost by themselves.

    Names of which one does nothing without the other imitate a third cause.
    """
    alone = {one.effect.key: one.evidence for one in found.first}
    return [
        one for one in candidates if one.name not in found.names and alone.get(one.key, 1.0) > 0
    ]
