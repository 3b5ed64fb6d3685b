"""Smooth functions of one variable that are others in each run."""

from dataclasses import dataclass, replace
from typing import Any, ClassVar

import numpy as np

from odometry.arrays import FloatArray
from odometry.effects.interface.base import EffectParameter
from odometry.effects.interface.base_model import Base
from odometry.effects.interface.time_course import run_numbers
from odometry.effects.unknown.residual import Residual
from odometry.models.inputs import Inputs


@dataclass(frozen=True)
class ResidualOfEachRun(Residual):
    """The same terms in each run, with its own coefficients; nothing in runs beyond these.

    Attributes
    ----------
    runs : int
    spread : float
        Standard deviation about zero that is expected of a coefficient.
    """

    runs: int = 1
    spread: float = 1.0

    course: ClassVar[str] = "of_each_run"
    in_words = "a cause that the catalogue does not have, in each run by its own"
    remedy = "look for what differs from run to run: wind, load, terrain, the map"

    @property
    def parameters(self) -> tuple[EffectParameter, ...]:
        """See `Effect.parameters`: those of the first run, then of the next."""
        own = super().parameters
        return tuple(
            replace(parameter, name=f"{parameter.name}_of_{run + 1}")
            for run in range(self.runs)
            for parameter in own
        )

    def columns(self, twist: FloatArray, inputs: Inputs, base: Base) -> FloatArray:
        """See `Residual.columns`."""
        of_any = super().columns(twist, inputs, base)
        numbers = run_numbers(inputs)
        return np.concatenate(
            [of_any * (numbers == run)[:, None] for run in range(self.runs)], axis=0
        )

    def with_run(self) -> "ResidualOfEachRun":
        """The same for one run more."""
        return replace(self, runs=self.runs + 1)

    def settings(self) -> dict[str, Any]:
        """See `Effect.settings`."""
        return {**super().settings(), "runs": self.runs, "spread": self.spread}
