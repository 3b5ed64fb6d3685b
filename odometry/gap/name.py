"""Which effects are missing: stepwise, on windows not fitted, or none, or unknown."""

from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace

from odometry.effects.base import Effect
from odometry.gap.candidates import contact_effects, of_angles, of_variables, quick_effects
from odometry.gap.config import GapConfig
from odometry.gap.contest import Judged, is_there, judge, ranked
from odometry.gap.explanation import Explanation
from odometry.gap.fit import Fitted, Fitter
from odometry.gap.sparse import sparse_residual
from odometry.gap.statistic import Gap, gap_of

LEAST_OF_NOISE = 0.2  # of what noise leaves: a smaller excess of chi-squared is taken as this
UNEXPLAINED = 1.3  # chi-squared a degree of freedom: more is not noise
POOR = 2.0  # chi-squared a degree of freedom that names leave which may be dropped
LEAST_CLOSED = 0.25  # share of the excess of chi-squared that they must close
MOVED = 50.0  # chi-squared of a base that left its calibration
CONTACT_SPREAD = 1.1  # chi-squared a degree of freedom that the quick forms must leave


def explained(
    fitter: Fitter, floor: Gap, config: GapConfig, progress: Callable[[], None]
) -> Explanation:
    """Name effects until none of the candidates earns a name.

    First by the catalogue alone. What that leaves is offered to smooth functions of an angle that
    no effect of the catalogue depends on (the heading, the wheels' angles); where one is there,
    it competes with the catalogue from the start, and the better explanation stands. A smooth
    function of any variable may take what is left at the end. Names that leave nearly all of a gap
    are dropped: what is there is unknown.
    """
    search = _Search(fitter, fitter.fit([]), floor, config, progress)
    scenes = fitter.measured.scenes
    quick = quick_effects(scenes, fitter.calibration)
    named = search.stepwise(quick)
    angle = search.best(named.fitted, of_angles(scenes))
    if angle is not None:
        with_angle = search.stepwise((*quick, angle.effect))
        if with_angle.cost < named.cost and "unknown" in with_angle.names:
            named = with_angle
    if "unknown" not in named.names:
        left = (*of_variables(scenes), *([] if angle is None else [angle.effect]))
        rest = search.best(named.fitted, left)
        if rest is not None:
            named = replace(named, steps=(*named.steps, rest))
    if search.explains_little(named):
        alone = search.best(named.start, (*of_angles(scenes), *of_variables(scenes)))
        named = replace(named, steps=() if alone is None else (alone,))
    named = search.simplest(named, quick)
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

    def simplest(self, found: Explanation, candidates: Sequence[Effect]) -> Explanation:
        """Effects exchanged for those that do the same with less freedom, where that is better.

        What the first of two effects did not need for itself it may have lent to the second.
        """
        for place, added in enumerate(found.fitted.effects):
            alike = added.effect.same_as(added.values)
            for other in candidates:
                simpler = len(other.parameters) < len(added.values)
                if simpler and other.name in alike and other.name not in found.names:
                    effects = [*found.effects[:place], other, *found.effects[place + 1 :]]
                    exchanged = self._in_order(found, effects)
                    found = exchanged if exchanged.cost < found.cost else found
        return found

    def _in_order(self, found: Explanation, effects: Sequence[Effect]) -> Explanation:
        """These effects, judged as they are added one by one."""
        steps: tuple[Judged, ...] = ()
        for effect in effects:
            before = steps[-1].fitted if steps else self.start
            (one,) = judge(self.fitter, before, [effect], self.config, self.progress)
            steps = (*steps, self._all_free(one, before))
        return replace(found, steps=steps)

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

    def explains_little(self, found: Explanation) -> bool:
        """Whether effects leave nearly all of what noise does not explain."""
        excess = self.start.cost - len(self.fitter.measured.window_of_row)
        poor = self.fitter.spread(found.fitted) > POOR
        return bool(poor and self.start.cost - found.fitted.cost < LEAST_CLOSED * excess)

    def unexplained(self) -> bool:
        """Whether the base leaves a gap, and even moved more chi-squared than noise explains."""
        believed = replace(self.start, base=self.fitter.calibration.base)
        over = self._gap(believed) > self.floor.high
        return over and self.fitter.spread(self.start) > UNEXPLAINED

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
        if not self._excess(before) or one.least <= self.config.least_evidence:
            return False
        share = self.config.least_share if before.effects else self.config.first_share
        noise = len(self.fitter.measured.window_of_row)
        excess_m = max(self._gap(self.start) - self.floor.value, 0.0)
        closed_m = self._gap(before) - one.gap_after
        excess = max(self.start.cost - noise, LEAST_OF_NOISE * noise)
        closed = before.cost - one.fitted.cost
        return is_there(one.fitted) and bool(
            closed_m > share * excess_m > 0 or closed > share * excess
        )
