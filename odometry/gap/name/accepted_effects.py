"""Which names stand: those that pass every gate on the runs measured and held out."""

from collections.abc import Sequence
from dataclasses import replace
from functools import cached_property

from odometry.effects.interface.base import Effect
from odometry.effects.interface.time_course import FromAMoment, Gradual, InBursts
from odometry.effects.unknown.residual import Residual
from odometry.gap.fit.own_moments import with_own_moments
from odometry.gap.name.explanation import Explanation
from odometry.gap.name.form import names_alone, of_their_form
from odometry.gap.name.form_gates import is_special, is_the_main_part
from odometry.gap.name.in_calibration import is_new
from odometry.gap.name.left_by_names import by_themselves, structure_left, that_last
from odometry.gap.name.near_rivals import undecided
from odometry.gap.name.search import Search
from odometry.gap.name.sudden import is_gradual_wheel_scale, sudden_instead, sudden_wheels
from odometry.gap.name.unnamed import grown, in_bursts, last_of_each_run, with_course
from odometry.gap.name.verdict import (
    closes_a_part,
    closes_held_out,
    closes_the_most,
    leaves_no_structure,
    leaves_noise,
    raises_measured,
    within_noise,
)
from odometry.gap.prepare.statistic import Gap, Shown, gap_of, root_mean_square
from odometry.windows.dense.dense import DenseWindows


class Standing(Search):
    """Keeps the effects that are accepted."""

    def that_stand(self, found: Explanation, smooth: Sequence[Residual]) -> Explanation:
        """The effects that close the gap where they were not fitted, and leave noise alone.

        Where no name does, one in bursts or wheels from a moment on may; else smooth functions do
        as far as they can, and their residuals may follow a course in time that is each run's own.
        Wheels that seem to change slowly may do so at a moment.
        """
        found = self._less_doubtful(self._of_their_form(found, smooth))
        if not found.has_name:
            sudden = of_their_form(self, sudden_wheels(self, found), smooth)
            named = [one for one in (in_bursts(self, found), sudden) if one.steps]
            found = min([grown(self, found), *named], key=lambda one: one.cost)
        elif any(is_gradual_wheel_scale(effect) for effect in found.effects):
            found = of_their_form(self, sudden_instead(self, found), smooth)
        found = self._without_structure(self._standing(found, smooth), smooth)
        found = self._for_itself(found, smooth)
        if not found.has_name and (found.steps or self.unexplained() or self.is_above):
            found = self._standing(with_course(self, found), smooth)
        refused = tuple(one for name, one in self.refusals.items() if name not in found.names)
        unexplained = not found.steps and self.unexplained()
        return replace(
            found,
            refusals=refused,
            unexplained=unexplained,
            base_closes=not found.steps and self.base_closes,
        )

    def _standing(self, found: Explanation, smooth: Sequence[Residual]) -> Explanation:
        """Without the last effects as long as they do not stand on held-out data.

        A smooth function that does not may have other coefficients in each run.
        """
        while found.steps:
            reason = self._fails(found)
            if not reason:
                break
            last = found.effects[-1]
            self.refuse(last, reason)
            if len(found.steps) == 1 and not isinstance(last, Residual):
                found = grown(self, found)
            else:
                own = last_of_each_run(self, found)
                found = own or self._of_their_form(found.less_last(), smooth)
        return found

    def _without_structure(self, found: Explanation, smooth: Sequence[Residual]) -> Explanation:
        """Without any name where all close little, or leave structure."""
        if not found.has_name:
            return found
        left, share = self._held_out_left(found)
        if share >= self._most(found.effects):
            return found
        structure = structure_left(self.fitter, found.fitted, self.config)
        of_gap, spread = (left, self.held_floor), self.fitter.spread(found.fitted)
        least = self._least_of_rest(found.effects)
        reason = (
            closes_a_part(share, self._least_part(found.effects))
            or closes_the_most(share, spread, of_gap, least, self.config)
            or leaves_no_structure(share, structure)
        )
        if not reason:
            return found
        for effect in found.effects:
            if not isinstance(effect, Residual):
                self.refuse(effect, reason)
        return self._standing(grown(self, found), smooth)

    def _for_itself(self, found: Explanation, smooth: Sequence[Residual]) -> Explanation:
        """Without names beside a smooth function that others equal, or more such alone beat.

        Beside names that last and leave no gap nothing is unknown: others may equal these.
        Forces of contacts, which are right and imperfect, give way to the others alone.
        """
        names = [effect for effect in found.effects if not isinstance(effect, Residual)]
        if not names or len(names) == len(found.effects):
            return found
        reason = undecided(found, self.fitter, self.config)
        if reason and (by_names := by_themselves(self, found)):
            return self._standing(by_names, smooth)
        if not reason and any(name.slow for name in names):
            return found
        alone = grown(self, found)
        if not reason and 0 < len(alone.steps) <= len(found.steps) and alone.cost < found.cost:
            reason = is_special(next(e for e in alone.effects if isinstance(e, Residual)))
        for name in names if reason else ():
            self.refuse(name, reason)
        return self._standing(alone, smooth) if reason else found

    def _held_out_left(self, found: Explanation) -> tuple[Gap, float]:
        """The gap that is left on held-out data, and the share of its excess that is closed.

        All of it where the gap is within the noise floor.
        """
        fit, part_s = found.fitted, self.config.part_s
        believed, scenes = self.fitter.calibration, self.fitter.measured.scenes
        effects, held_out = with_own_moments(fit.base, fit.effects, self.held_out, scenes, believed)
        measure = self.floor.measure
        after = gap_of(fit.base, effects, held_out, part_s, measure)
        before = root_mean_square(believed.base, (), held_out, measure)
        if after.value <= self.held_floor.high:
            return after, 1.0
        return after, (before - after.value) / (before - self.held_floor.value)

    def _most(self, names: Sequence[Effect]) -> float:
        """Share of an excess that these need to close where they leave what is not noise."""
        by_contact = any(effect.slow for effect in names)
        return self.config.contact_closed if by_contact else self.config.mostly_closed

    def _least_of_rest(self, names: Sequence[Effect]) -> float:
        """The same on held-out data, less of names that are never exact there.

        Forces of contacts, what comes slowly or in bursts, and faults of the reference.
        """
        never = {Gradual.name, InBursts.name}
        if any(one.slow or one.of_reference or one.course in never for one in names):
            return self.config.least_of_rest
        return self.config.mostly_closed

    def _most_fitted(self, names: Sequence[Effect]) -> float:
        """The same on the measured runs, whose moments are known: what begins at one closes more.

        A step closes most of what comes slowly, too.
        """
        sudden = any(effect.course == FromAMoment.name for effect in names)
        by_contact = any(effect.slow for effect in names)
        return self.config.bursts_closed if sudden and not by_contact else self._most(names)

    def _least_part(self, names: Sequence[Effect]) -> float:
        """Held out, whatever they leave: bursts, chosen by errors, close some of anything."""
        in_bursts = any(effect.course == InBursts.name for effect in names)
        return self.config.least_of_rest if in_bursts else self.config.least_held_out

    def _believed_gap(self) -> float:
        """On the measured windows, of the base as it was calibrated."""
        return self._gap(replace(self.start, base=self.fitter.calibration.base))

    def _of_their_form(self, found: Explanation, smooth: Sequence[Residual]) -> Explanation:
        """Without names that do not have the form of what they stand for."""
        left = of_their_form(self, found, smooth)
        return left if left.steps or not found.steps else grown(self, found)

    def _less_doubtful(self, found: Explanation) -> Explanation:
        """Without any name where all leave what is not noise, or are not what does the work."""
        alone = names_alone(self.fitter, found)
        names = [added.effect for added in alone.effects]
        if not names:
            return found
        noise = self.fitter.measured.expected
        excess = max(self.start.cost - noise, self.config.least_excess * noise)
        closed = (self.start.cost - alone.cost) / excess
        reason = leaves_noise(
            self.fitter.spread(alone), closed, self.config.left_over, self._most_fitted(names)
        )
        of_all = self.start.cost - found.fitted.cost
        reason = reason or is_the_main_part(self.start.cost - alone.cost, of_all, self.config)
        left = that_last(self, found) if reason else found
        if left is not None:
            return left
        for name in names:
            self.refuse(name, reason)
        return grown(self, found)

    def unexplained(self) -> bool:
        """Whether the base leaves a gap, and even moved more chi-squared than noise explains."""
        over = self._believed_gap() > self.floor.high
        return over and self.fitter.spread(self.start) > self.config.unexplained

    def _fails(self, found: Explanation) -> str:
        """Why the last effect does not stand on held-out data, beyond what the others close.

        What a base beside the others closes by leaving its calibration is the effect's, if that
        brings the base back; a latency that is not as calibrated is an effect by itself.
        """
        fit, before = found.fitted, (found.steps[-2].fitted if found.steps[1:] else self.start)
        hidden = self.explains_move(fit, before) or (
            found.steps[1:] and self._left(before) and self._brings_back(fit, before)
        )
        believed = self.fitter.calibration.base
        less_base = replace(fit.base if hidden else before.base, latency_s=believed.latency_s)
        pairs = [(less_base, before.effects), (believed, ())]
        known, scenes = self.fitter.calibration, self.fitter.measured.scenes
        effects, held_out = with_own_moments(fit.base, fit.effects, self.held_out, scenes, known)
        measure = self.floor.measure
        last = fit.effects[-1]
        reasons = [
            "" if isinstance(last.effect, Residual) else is_new(last, known, self.config),
            within_noise(self._at_first(held_out), self.config),
            raises_measured(self._believed_gap(), self._gap(fit), measure),
            *(
                closes_held_out(
                    (base, effects[: len(less)]),
                    (fit.base, effects),
                    held_out,
                    self.held_floor,
                    self.config,
                )
                for base, less in pairs
            ),
        ]
        return next((reason for reason in reasons if reason), "")

    def _at_first(self, held_out: Sequence[DenseWindows]) -> Shown:
        """The gaps of the base as it was calibrated, on held-out and on measured windows."""
        base, measure = self.fitter.calibration.base, self.floor.measure
        held = gap_of(base, (), held_out, self.config.part_s, measure)
        return Shown((held, self.held_floor), (self._measured_at_first, self.floor))

    @cached_property
    def _measured_at_first(self) -> Gap:
        base, scenes = self.fitter.calibration.base, self.fitter.measured.scenes
        return gap_of(base, (), scenes, self.config.part_s, self.floor.measure)
