"""A gap result as sentences."""

from collections.abc import Iterator, Sequence
from dataclasses import dataclass, replace

import numpy as np

from odometry.checks.findings.warned import faults_words
from odometry.digits import within_interval
from odometry.effects.interface.base_model import Base
from odometry.effects.unknown.residual import Residual
from odometry.gap.answer.result import GapResult, NamedEffect
from odometry.gap.locate.region_words import EVERYWHERE, noun_of, noun_of_residual
from odometry.gap.prepare.calibration import Calibration
from odometry.gap.show.by_run import runs_differ
from odometry.gap.show.lead import lead
from odometry.gap.show.quantities import evidence_words, metres, with_interval

REGIONS, VARIABLES = 2, 4  # that are named
SHORT = 4  # parameters that are given one by one

FAR = 3.0  # standard deviations, from which a change is reported
RIDGE = 1e-9  # the calibration may leave a number open


def sentences(result: GapResult) -> tuple[str, ...]:
    """What is missing, how sure, what to do (`odometry.gap.show.lead`), then what that rests on.

    What the check warns of stands after the first three, where it warns.
    """
    return (
        *lead(result),
        *filter(None, [faults_words(result.faults)]),
        _disagreement(result),
        *filter(None, [runs_differ(result)]),
        *_where(result),
        *(_effect(effect, number) for number, effect in enumerate(result.effects, start=1)),
        *_moved(result),
        *(
            f"Not {_refused(one.name)}, though it has evidence: {one.reason}."
            for one in result.refusals
        ),
    )


def effect_words(effect: NamedEffect) -> str:
    """An effect as a roboticist names it, then its name and form."""
    added = effect.added.effect
    if isinstance(added, Residual):
        return f"a smooth function of {noun_of_residual(added)}"
    return f"{effect.added.in_words} ({added.name}, {added.form.replace('_', ' ')})"


def _refused(name: str) -> str:
    return "a smooth function of one variable" if name == Residual.name else name


def _disagreement(result: GapResult) -> str:
    return (
        f"Over windows of {result.horizon_s:g} s the simulated position ends "
        f"{with_interval(result.measured.before)} from the measured one on the measured runs: a "
        "root mean square, with its 95 % interval in brackets."
    )


def _where(result: GapResult) -> Iterator[str]:
    location = result.location
    found = [noun_of(one.name) for one in location.predictors if one.discovered]
    if found:
        more = len(found) - VARIABLES
        others = f", and {more} more" if more > 0 else ""
        several = " They go together in these runs: none of them need be the cause."
        yield (
            f"What predicts the disagreement: {', '.join(found[:VARIABLES])}{others}."
            f"{several if len(found) > 1 else ''}"
        )
    elif location.predictors:
        yield "None of the recorded variables predicts the disagreement beyond chance."
    for number, region in enumerate(location.regions[:REGIONS]):
        if region.words == EVERYWHERE:
            yield "None of them says where it is larger."
            continue
        which = "The largest part of it" if number == 0 else "The next part"
        yield (
            f"{which}, {100 * region.share:.0f} % of what noise does not explain: {region.words}; "
            f"there it is {metres(region.excess_m)} above the noise floor."
        )


def _effect(effect: NamedEffect, number: int) -> str:
    kind = effect.added.effect
    place = f"Effect {number}, {effect_words(effect)}, acts on the {kind.acts_on}"
    strength = f"evidence {effect.evidence:.0f}, {evidence_words(effect.evidence)}"
    if effect.gap_after > effect.gap_before:
        strength += ", by headings and the way there: the ends of the windows are no nearer"
    gap = (
        f"on the measured runs the gap goes from {metres(effect.gap_before)} to "
        f"{metres(effect.gap_after)} ({strength})"
    )
    if isinstance(kind, Residual):
        return f"{place}, and describes it by {len(effect.added.values)} numbers; {gap}."
    if len(effect.added.values) > SHORT:
        return f"{place} with {len(effect.added.values)} parameters; {gap}."
    return f"{place}: {', '.join(parameter_words(effect))}; {gap}."


def parameter_words(effect: NamedEffect) -> Sequence[str]:
    """Each parameter with its 95 % interval; those with which it does nothing as "none"."""
    added, said = effect.added, []
    for p, *ends in zip(
        added.effect.parameters, added.values, effect.low, effect.high, strict=True
    ):
        if ends[0] == p.absent:
            said.append(f"{p.name}: none")
            continue
        value, low, high = within_interval(*map(float, ends))
        said.append(f"{p.name} = {value}{' ' + p.unit if p.unit else ''} ({low} to {high})")
    return said


@dataclass(frozen=True)
class Moved:
    """A number of the base: as calibrated, as it is after the fit, and how sure it was."""

    name: str
    unit: str
    before: float
    after: float
    sigma: float

    @property
    def sigmas(self) -> float:
        """The move in standard deviations of the calibration."""
        return abs(self.after - self.before) / self.sigma

    @property
    def is_far(self) -> bool:
        """Whether it moved farther than its calibration allows."""
        return self.sigmas > FAR


def moves_of(calibration: Calibration, base: Base) -> tuple[Moved, ...]:
    """Of every number that the calibration leaves uncertain, in its order."""
    uncertain = calibration.uncertain
    values = uncertain.values
    if not len(values):
        return ()
    information = calibration.information + RIDGE * np.eye(len(values))
    sigmas = np.sqrt(np.diag(np.linalg.inv(information)))
    after = replace(uncertain, base=base).values
    units = {parameter.name: parameter.unit for parameter in base.model.parameters}
    units |= {"latency": "s", "gyro_latency": "s"}
    return tuple(
        Moved(name, units[name], *map(float, numbers))
        for name, *numbers in zip(uncertain.names, values, after, sigmas, strict=True)
    )


def _moved(result: GapResult) -> Iterator[str]:
    """What moved farther than its calibration allows; with `none`, that no gap shows it."""
    shown = "" if result.verdict != "none" else ", though the gap on held-out data does not show it"
    for moved in moves_of(result.calibration, result.base):
        if moved.is_far:
            yield f"{moved_words(moved)}{shown}."


def moved_words(moved: Moved) -> str:
    """How far it moved, a sentence without its full stop."""
    unit = f" {moved.unit}" if moved.unit else ""
    share = (moved.after - moved.before) / moved.before if moved.before else 0.0
    by = f" ({100 * share:+.1f} %)" if not moved.unit and share else ""
    return (
        f"{moved.name} of the base moved from {moved.before:.4g} to {moved.after:.4g}{unit}{by}, "
        f"{moved.sigmas:.0f} standard deviations of its calibration: more than chance explains"
    )
