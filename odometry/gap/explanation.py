"""Effects that explain measured runs."""

from dataclasses import dataclass

from odometry.effects.base import Effect
from odometry.gap.contest import Judged, penalty
from odometry.gap.fit import Fitted


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
        return self.fitted.cost + penalty(self.fitted.freedom, self.fitted)
