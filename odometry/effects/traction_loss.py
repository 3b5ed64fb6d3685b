"""Traction that is lost from some moment on."""

from math import inf

import numpy as np

from odometry.arrays import FloatArray
from odometry.effects.base import Base, EffectParameter, MotionEffect
from odometry.models.inputs import Inputs

SPACING_S, MOST_MOMENTS = 3.0, 60  # of the moments from which a search begins


class TractionLoss(MotionEffect):
    """From a moment on the robot drives and turns by a share of what it did before."""

    name = "traction_loss"
    form = "k_m"
    equation = "from the moment on: v_x -> k v_x, (v_y, omega) -> m (v_y, omega)"
    source = "Salvi 2024 eq. 3"
    looks_like = "a model that fits up to some moment, and is off by one share after it"
    needs = "tread speeds and a measured pose, before and after the moment"

    def __init__(
        self, longest_s: float = 1e4, observed_s: tuple[float, float] = (-inf, inf)
    ) -> None:
        """A loss in runs of at most `longest_s`; moments outside of `observed_s` are none."""
        self.longest_s = longest_s
        self.observed_s = observed_s

    @property
    def parameters(self) -> tuple[EffectParameter, ...]:
        """See `Effect.parameters`; `moment` is run time."""
        return (
            EffectParameter("k", "", 0.0, 2.0, 1.0, 0.01, 1.0),
            EffectParameter("m", "", 0.0, 2.0, 1.0, 0.01, 1.0),
            EffectParameter("moment", "s", 0.0, self.longest_s, self.longest_s / 2, 1.0, None),
        )

    def lacks(self, inputs: Inputs, base: Base) -> str:  # noqa: ARG002 - of the face
        """See `Effect.lacks`."""
        return "" if inputs.time_s is not None else "stamps"

    def starts(self, inputs: Inputs, base: Base) -> FloatArray:  # noqa: ARG002 - of the face
        """Moments evenly spread over the run."""
        longest_s = self.longest_s if inputs.time_s is None else float(inputs.time_s.max())
        count = int(np.clip(longest_s / SPACING_S, 1, MOST_MOMENTS))
        moments = longest_s * (np.arange(count) + 0.5) / count
        return np.stack([np.ones(count), np.ones(count), moments], axis=-1)

    def is_meant(self, values: FloatArray) -> bool:
        """A moment before or after which nothing was measured is none."""
        earliest_s, latest_s = self.observed_s
        return bool(earliest_s <= values[2] <= latest_s)

    def twist(
        self,
        values: FloatArray,
        twist: FloatArray,
        inputs: Inputs,
        base: Base,  # noqa: ARG002 - of the face
    ) -> FloatArray:
        """See `MotionEffect.twist`; the sample in which the moment lies is shared out."""
        k, m, moment = values
        time_s = inputs.time_s
        if time_s is None:
            return twist
        steps_s = np.append(np.diff(time_s), 0.0)
        steps_s = np.where(steps_s > 0, steps_s, 0.02)
        after = np.clip((time_s + steps_s - moment) / steps_s, 0.0, 1.0)[:, None]
        return np.asarray(twist * (1 + after * (np.array([k, m, m]) - 1)))
