"""Effects that the data cannot separate from those named."""

from odometry.effects.corrected import Added
from odometry.effects.residual import Residual
from odometry.gap.config import GapConfig
from odometry.gap.explanation import Explanation
from odometry.gap.result import Equivalent

TELL_APART = "a run in which the two differ: other speeds, turns or terrain"


def equivalents(found: Explanation, config: GapConfig) -> tuple[Equivalent, ...]:
    """What is alike by its equations, and what came as near in the contest for the same place.

    An effect that includes another has values to spare for whatever else is imperfect: the other
    is as near where it closes nearly as much.
    """
    alike: dict[str, Equivalent] = {}
    for added in found.fitted.effects:
        _add_same(alike, added)
    for step in found.steps:
        if isinstance(step.effect, Residual):
            continue
        rivals = found.contests.get(step.effect.name, ())
        best = next((one for one in rivals if one.effect.name == step.effect.name), step)
        for rival in rivals:
            if rival.effect.name == step.effect.name or rival.effect.name in alike:
                continue
            is_part = rival.effect.name in best.effect.includes
            closes_as_much = is_part and rival.gain > config.mostly_closed * best.gain
            if closes_as_much or best.evidence - rival.evidence < config.equivalent_margin:
                reasons = {**best.effect.alike, **best.effect.includes}
                reason = reasons.get(rival.effect.name, TELL_APART)
                alike[rival.effect.name] = Equivalent(rival.effect.name, best.effect.name, reason)
                _add_same(alike, rival.fitted.effects[-1])
    return tuple(one for name, one in alike.items() if name not in found.names)


def _add_same(alike: dict[str, Equivalent], added: Added) -> None:
    """What does the same as an effect named, or as an equivalent of one."""
    for name, told_apart_by in added.effect.same_as(added.values).items():
        alike.setdefault(name, Equivalent(name, added.effect.name, told_apart_by))
