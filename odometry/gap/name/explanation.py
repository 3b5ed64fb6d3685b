"""Effects that explain measured runs."""

from collections.abc import Mapping
from dataclasses import dataclass, field, replace

from odometry.effects.interface.base import Effect
from odometry.effects.unknown.residual import Residual
from odometry.gap.fit.contest import Judged, cost_of
from odometry.gap.fit.fitter import Fitted
from odometry.gap.name.verdict import Refusal


@dataclass(frozen=True)
class Explanation:
    """Effects in the order added, each as it was evaluated when it was added.

    Attributes
    ----------
    start : Fitted
        No effect: the base, moved within its calibration.
    steps : tuple of Judged
    first : tuple of Judged
        All candidates for the first effect, most evidence first.
    contests : Mapping of name to tuple of Judged
        All candidates of the contest in which the effect of that name was added.
    refusals : tuple of Refusal
        Names that had evidence and do not stand.
    base_closes : bool
        Whether no effect is accepted, and the base closes some of the gap with other values.
    unexplained : bool
        Whether there is a gap that noise does not explain, and nothing earned a name.
    """

    start: Fitted
    steps: tuple[Judged, ...]
    first: tuple[Judged, ...]
    contests: Mapping[str, tuple[Judged, ...]] = field(default_factory=dict)
    refusals: tuple[Refusal, ...] = ()
    base_closes: bool = False
    unexplained: bool = False

    @property
    def fitted(self) -> Fitted:
        """With all effects."""
        return self.steps[-1].fitted if self.steps else self.start

    @property
    def has_name(self) -> bool:
        """Whether an effect is none that stands for something unknown."""
        return any(not isinstance(effect, Residual) for effect in self.effects)

    def with_step(self, step: Judged) -> "Explanation":
        """The same and one effect more."""
        return replace(self, steps=(*self.steps, step))

    def less_last(self) -> "Explanation":
        """The same without the last effect."""
        return replace(self, steps=self.steps[:-1])

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
        return cost_of(self.fitted)
