"""Which effects are missing: stepwise, on windows not fitted, or none, or unknown."""

from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace

import numpy as np

from odometry.effects.base import Effect
from odometry.gap.candidates import (
    contact_effects,
    quick_effects,
    smooth_effects,
    unnamed_effects,
)
from odometry.gap.config import GapConfig
from odometry.gap.contest import Judged, judge, penalty, ranked
from odometry.gap.fit import Fitted, Fitter
from odometry.gap.sparse import sparse_residual
from odometry.gap.statistic import Gap, gap_of

LEAST_OF_NOISE = 0.2  # of what noise leaves: a smaller excess of chi-squared is taken as this
UNEXPLAINED = 1.3  # chi-squared a degree of freedom: more is not noise
SURE = 3.0  # standard deviations from doing nothing
MOVED = 50.0  # chi-squared of a base that left its calibration
CONTACT_SPREAD = 1.1  # chi-squared a degree of freedom that the quick forms must leave


@dataclass(frozen=True)
class Explanation:
    """Effects in the order added, each as it was judged when it was added.

    Attributes
    ----------
    start : Fitted
        No effect: the base, moved within its calibration.
    steps : tuple of Judged
    first : tuple of Judged
        All candidates for the first effect, most evidence first.
    unexplained : bool
        Whether there is a gap that noise does not explain, and nothing earned a name.
    """

    start: Fitted
    steps: tuple[Judged, ...]
    first: tuple[Judged, ...]
    unexplained: bool = False

    @property
    def fitted(self) -> Fitted:
        """With all effects."""
        return self.steps[-1].fitted if self.steps else self.start

    @property
    def effects(self) -> tuple[Effect, ...]:
        """In the order added."""
        return tuple(step.effect for step in self.steps)

    @property
    def names(self) -> tuple[str, ...]:
        """Of the effects."""
        return tuple(effect.name for effect in self.effects)

    @property
    def cost(self) -> float:
        """Held-out chi-squared, the move of the base and a penalty for freedom included."""
        fit = self.fitted
        return float(fit.held_out.sum()) + fit.base_moved + penalty(fit.freedom, fit)


def explained(
    fitter: Fitter, floor: Gap, config: GapConfig, progress: Callable[[], None]
) -> Explanation:
    """Name effects until none of the candidates earns a name.

    First by the catalogue alone. What that leaves is offered to smooth functions of an angle that
    no effect of the catalogue depends on (the heading, the wheels' angles); where one is there,
    it competes with the catalogue from the start, and the better explanation stands. A smooth
    function of any variable may take what is left at the end.
    """
    search = _Search(fitter, fitter.fit([]), floor, config, progress)
    scenes = fitter.measured.scenes
    quick = quick_effects(scenes, fitter.calibration)
    named = search.stepwise(quick)
    angle = search.best(named.fitted, unnamed_effects(scenes))
    if angle is not None:
        with_angle = search.stepwise((*quick, angle.effect))
        if with_angle.cost < named.cost and "unknown" in with_angle.names:
            named = with_angle
    if "unknown" not in named.names:
        rest = search.best(named.fitted, smooth_effects(scenes))
        if rest is not None:
            named = Explanation(named.start, (*named.steps, rest), named.first)
    return replace(named, unexplained=not named.steps and search.unexplained())


@dataclass(frozen=True)
class _Search:
    fitter: Fitter
    start: Fitted
    floor: Gap
    config: GapConfig
    progress: Callable[[], None]

    def stepwise(self, candidates: Sequence[Effect]) -> Explanation:
        """Add the candidate of most evidence until none earns a name."""
        start = self.start
        steps: tuple[Judged, ...] = ()
        first: tuple[Judged, ...] = ()
        while len(steps) < self.config.most_effects:
            before = steps[-1].fitted if steps else start
            if steps and not self._excess(before):
                break
            taken = {added.effect.name for added in before.effects}
            judged = self._judged(before, [c for c in candidates if c.name not in taken])
            first = first or tuple(judged)
            best = self._best_earner(judged, before)
            if best is None:
                break
            steps = (*steps, self._all_free(best, before))
        return Explanation(start, steps, first)

    def best(self, before: Fitted, candidates: Sequence[Effect]) -> Judged | None:
        """The candidate of most evidence, made sparse, if it earns its place."""
        if not self._excess(before):
            return None
        judged = judge(self.fitter, before, candidates, self.config, self.progress)
        best = self._best_earner(judged, before)
        if best is None:
            return None
        sparse = sparse_residual(self.fitter, best.fitted)
        again = judge(self.fitter, before, [sparse], self.config, self.progress)[0]
        return again if self._earns(again, before) else best

    def _judged(self, before: Fitted, candidates: Sequence[Effect]) -> list[Judged]:
        """The quick forms, and those of contact forces where the quick ones leave something."""
        judged = judge(self.fitter, before, candidates, self.config, self.progress)
        best = self._best_earner(judged, before)
        if best is None or self.fitter.spread(best.fitted) < CONTACT_SPREAD:
            return judged
        taken = {added.effect.name for added in before.effects}
        scenes, calibration = self.fitter.measured.scenes, self.fitter.calibration
        slow = [e for e in contact_effects(scenes, calibration) if e.name not in taken]
        more = judge(self.fitter, before, slow, self.config, self.progress)
        fits = [one.fitted for one in (*judged, *more)]
        return ranked(self.fitter, before, fits, self.config)

    def _all_free(self, one: Judged, before: Fitted) -> Judged:
        """The same with the parameters of slow effects, held in the contest, free again."""
        if not any(added.effect.slow for added in before.effects):
            return one
        effects = [added.effect for added in one.fitted.effects]
        fit = self.fitter.fit(effects, one.fitted.effects)
        return replace(ranked(self.fitter, before, [fit], self.config)[0], evidence=one.evidence)

    def unexplained(self) -> bool:
        """Whether the base leaves a gap, and more in chi-squared than noise explains."""
        return self._excess(self.start) and self.fitter.spread(self.start) > UNEXPLAINED

    def _excess(self, before: Fitted) -> bool:
        """Whether the gap is above the interval of the noise floor, or hidden in a moved base."""
        return self._gap(before) > self.floor.high or before.base_moved > MOVED

    def _gap(self, fit: Fitted) -> float:
        scenes = self.fitter.measured.scenes
        return gap_of(fit.base, fit.effects, scenes, self.config.part_s).value

    def _best_earner(self, judged: Sequence[Judged], before: Fitted) -> Judged | None:
        """Of most evidence among those that earn a name."""
        return next((one for one in judged if self._earns(one, before)), None)

    def _earns(self, one: Judged, before: Fitted) -> bool:
        """Enough evidence, in more than one moment, and enough of the excess closed.

        The excess is that before any effect, of the gap above the noise floor or of chi-squared
        above what noise explains: a better heading is worth as much as a better place.
        """
        if not self._excess(before) or one.without_best <= self.config.least_evidence:
            return False
        share = self.config.least_share if before.effects else self.config.first_share
        noise = len(self.fitter.measured.window_of_row)
        excess_m = max(self._gap(self.start) - self.floor.value, 0.0)
        closed_m = self._gap(before) - one.gap_after
        excess = max(_cost(self.start) - noise, LEAST_OF_NOISE * noise)
        closed = _cost(before) - _cost(one.fitted)
        return is_there(one.fitted) and bool(
            closed_m > share * excess_m > 0 or closed > share * excess
        )


def is_there(fit: Fitted) -> bool:
    """Whether the last effect of a fit is more than an effect that does nothing.

    Its parameters are tested together (Wald), those that shape it held: each alone may be
    uncertain where only a product of them is known.
    """
    added = fit.effects[-1]
    absent = [parameter.absent for parameter in added.effect.parameters]
    known = np.array([value is not None for value in absent])
    if not known.any():
        return True
    away = np.array([a - b for a, b in zip(added.values, absent, strict=True) if b is not None])
    count = len(absent)
    scales = np.array([parameter.scale for parameter in added.effect.parameters])
    covariance = fit.covariance[-count:, -count:] / np.outer(scales, scales)
    information = np.linalg.pinv(covariance, hermitian=True)[np.ix_(known, known)]
    away = away / scales[known]
    return bool(away @ information @ away > SURE**2 * known.sum())


def _cost(fit: Fitted) -> float:
    return float(fit.held_out.sum()) + fit.base_moved
