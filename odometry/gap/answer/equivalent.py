"""Effects that the data cannot separate from those named."""

from collections.abc import Sequence

from odometry.effects.interface.corrected import Added
from odometry.effects.unknown.residual import Residual
from odometry.gap.answer.result import Equivalent
from odometry.gap.config import GapConfig
from odometry.gap.fit.contest import Judged, judge
from odometry.gap.fit.fitter import Fitter
from odometry.gap.name.candidates import effects_of_one_heading
from odometry.gap.name.explanation import Explanation
from odometry.gap.name.near_rivals import as_near

TELL_APART = "a run in which the two differ: other speeds, turns or terrain"


def rivals_of_one_heading(
    found: Explanation, fitter: Fitter, config: GapConfig
) -> tuple[Judged, ...]:
    """Effects that few headings do not distinguish from the first name, fitted in its place.

    These are no candidates there, because their own parameters could not be determined separately.
    """
    if not found.names or isinstance(found.effects[0], Residual):
        return ()
    absent = effects_of_one_heading(fitter.measured.scenes, fitter.calibration)
    return tuple(judge(fitter, found.start, absent, config, lambda: None))


def equivalents(
    found: Explanation, more: Sequence[Judged], fitter: Fitter, config: GapConfig
) -> tuple[Equivalent, ...]:
    """Effects that are equal by their equations, and those that came as near in the same contest.

    An effect that includes another has values to spare for whatever else is imperfect: the other
    is as near where it closes nearly as much. `more` are rivals of the first name that were no
    candidates. Where nothing is named see `done_by_others_too`.
    """
    if all(isinstance(effect, Residual) for effect in found.effects):
        return done_by_others_too(found, config)
    alike: dict[str, Equivalent] = {}
    for added in found.fitted.effects:
        _add_same(alike, added, by_equation=True)
    for place, step in enumerate(found.steps):
        if isinstance(step.effect, Residual):
            continue
        rivals = (*found.contests.get(step.effect.name, ()), *(() if place else more))
        best = next((one for one in rivals if one.effect.name == step.effect.name), step)
        for rival in as_near(best, rivals, fitter, config):
            if rival.effect.name in alike:
                continue
            reasons = {**best.effect.alike, **best.effect.includes}
            reason = reasons.get(rival.effect.name, TELL_APART)
            alike[rival.effect.name] = Equivalent(rival.effect.name, best.effect.name, reason)
            _add_same(alike, rival.fitted.effects[-1])
    return tuple(one for name, one in alike.items() if name not in found.names)


def done_by_others_too(found: Explanation, config: GapConfig) -> tuple[Equivalent, ...]:
    """The first candidate, where it is refused as something else moves a robot in the same way.

    In place of "unknown", if it closes nearly as much as the smooth functions that are added.
    """
    if not found.first:
        return ()
    best = found.first[0]
    refused = any((one.name, one.form) == _named(best) for one in found.refusals)
    closed = found.start.cost - found.fitted.cost
    if not (best.effect.mimicked_by and refused and best.gain >= config.mostly_closed * closed):
        return ()
    return (Equivalent(best.effect.name, "unknown", best.effect.remedy),)


def _named(one: Judged) -> tuple[str, str]:
    return one.effect.name, one.effect.form


def _add_same(alike: dict[str, Equivalent], added: Added, *, by_equation: bool = False) -> None:
    """What does the same as an effect named, or as an equivalent of one."""
    for name, told_apart_by in added.effect.same_as(added.values).items():
        one = Equivalent(name, added.effect.name, told_apart_by, by_equation)
        alike.setdefault(name, one)
