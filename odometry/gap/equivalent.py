"""Effects that the data cannot separate from those named."""

from odometry.gap.explanation import Explanation
from odometry.gap.result import Equivalent

MARGIN = 6.0  # of evidence: less says nothing of which it is
TELL_APART = "a run in which the two differ: other speeds, turns or terrain"


def equivalents(found: Explanation) -> tuple[Equivalent, ...]:
    """What is alike by its equations, and what competed for the first place and came as near."""
    alike: dict[str, Equivalent] = {}
    for added in found.fitted.effects:
        for name, told_apart_by in added.effect.same_as(added.values).items():
            alike[name] = Equivalent(name, added.effect.name, told_apart_by)
    if found.steps:
        best = found.steps[0]
        for rival in found.first:
            if rival.effect.name == best.effect.name or rival.effect.name in alike:
                continue
            if best.gain - rival.gain < MARGIN * best.gain / max(best.evidence, 1e-9):
                reason = best.effect.alike.get(rival.effect.name, TELL_APART)
                alike[rival.effect.name] = Equivalent(rival.effect.name, best.effect.name, reason)
    return tuple(one for name, one in alike.items() if name not in found.names)
