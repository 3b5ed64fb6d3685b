"""A part of the motion that follows earlier or later tread speeds."""

from dataclasses import dataclass

import numpy as np

from odometry.arrays import FloatArray
from odometry.effects.commands.held_commands import held_spans, late_speeds
from odometry.effects.interface.base import EffectParameter
from odometry.effects.interface.base_model import Base
from odometry.effects.unknown.residual import TREADS, Residual
from odometry.errors import ParameterError
from odometry.models.inputs import Inputs

HISTORY = "speed_history"
BOTH = "treads"
LAGS_S = (-0.8, -0.4, -0.2, -0.1, 0.1, 0.2, 0.4, 0.8)


@dataclass(frozen=True)
class History(Residual):
    """Tread speeds as a weighted sum of those recorded at several lags: any linear filter.

    Delays, lags, swings and means over a while are all of this form, and none of them by name.
    Of `Residual`, `variable` is HISTORY, `knots` are the lags [s], a term is (BOTH or a tread,
    number of the lag), and `by` is not used.
    """

    variable: str = HISTORY
    terms: tuple[tuple[str, int], ...] = tuple((BOTH, number) for number in range(len(LAGS_S)))
    knots: tuple[float, ...] = LAGS_S

    def __post_init__(self) -> None:
        known = [(tread, k) for tread in (BOTH, *TREADS) for k in range(len(self.knots))]
        if self.variable != HISTORY or any(tuple(term) not in known for term in self.terms):
            raise ParameterError(
                f"the residual of {self.variable!r} has terms {self.terms}, expected {HISTORY!r} "
                f"and a term of {known}"
            )

    form = "history"
    equation = "v(t) -> v(t) + sum of c_k (v(t - lag_k) - v(t))"
    looks_like = "errors after or before changes of speed"
    remedy = "compare the recorded speeds with what the treads do, sample by sample"

    @property
    def parameters(self) -> tuple[EffectParameter, ...]:
        """See `Effect.parameters`."""
        return tuple(
            EffectParameter(f"{name}_{number}", "", -10.0, 10.0, 0.0, 0.01)
            for name, number in self.terms
        )

    @property
    def answers_to(self) -> str:
        """See `MotionEffect.answers_to`: treads go through the base."""
        return "base"

    def lacks(self, inputs: Inputs, base: Base) -> str:  # noqa: ARG002 - of the interface
        """See `Effect.lacks`."""
        return "stamps" if inputs.time_s is None else ""

    def columns(self, twist: FloatArray, inputs: Inputs, base: Base) -> FloatArray:
        """See `Residual.columns`; what is added to treads is a change to first order.

        Raises
        ------
        ParameterError
            If there are no stamps.
        """
        if inputs.time_s is None:
            raise ParameterError("the residual is a function of earlier speeds: no stamps")
        speeds = np.asarray(inputs.tread_speeds_m_s)
        held_s, starts = held_spans(inputs.time_s)
        slopes = base.model.speed_jacobian(base.values, inputs)
        made = np.zeros((len(self.terms), *twist.shape))
        for place, (name, number) in enumerate(self.terms):
            changed = late_speeds(speeds, held_s, starts, self.knots[number]) - speeds
            own = np.array([name in (BOTH, tread) for tread in TREADS])
            made[place] = np.einsum("nij,nj->ni", slopes, changed * own)
        return made
