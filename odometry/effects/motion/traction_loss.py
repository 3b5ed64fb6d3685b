"""Traction that is lost at some moment."""

from typing import ClassVar

import numpy as np

from odometry.arrays import FloatArray
from odometry.effects.interface.base import Effect, EffectParameter, MotionEffect
from odometry.effects.interface.base_model import Base
from odometry.effects.interface.in_course import in_course
from odometry.effects.interface.recorded import Recorded
from odometry.effects.interface.time_course import FromAMoment, Gradual
from odometry.models.inputs import Inputs

NO_GAIN = 1.02  # a share that noise makes of one


class TractionLoss(MotionEffect):
    """The robot drives and turns by a share of what it did before; always in a course of time."""

    name = "traction_loss"
    form = "k_m"
    in_words = "traction that is lost"
    equation = "v_x -> k v_x, (v_y, omega) -> m (v_y, omega)"
    source = "Salvi 2024 eq. 3"
    looks_like = "a model that fits at some times, and is off by one share at others"
    remedy = "look at the treads, the tyres and the terrain at these times"
    needs = "tread speeds and a measured pose, with and without the loss"
    alike: ClassVar[dict[str, str]] = {
        "wheel_scale": "a second measure of tread travel (a motor current, a free wheel): a "
        "uniform factor of both wheels looks like slip"
    }

    @property
    def parameters(self) -> tuple[EffectParameter, ...]:
        """See `Effect.parameters`."""
        return (
            EffectParameter("k", "", 0.0, 2.0, 1.0, 0.01, 1.0),
            EffectParameter("m", "", 0.0, 2.0, 1.0, 0.01, 1.0),
        )

    @classmethod
    def offered(cls, recorded: Recorded) -> tuple[Effect, ...]:
        """From a moment on, and gradual: always there it is slip, which the model has."""
        return (
            in_course(cls(), FromAMoment(recorded.observed_s)),
            in_course(cls(), Gradual(recorded.longest_s)),
        )

    def is_meant(self, values: FloatArray) -> bool:
        """A loss is no gain, and turns lose at least: what brakes speed alone has another cause."""
        return bool((values <= NO_GAIN).all() and values[1] < 1 / NO_GAIN)

    def twist(
        self,
        values: FloatArray,
        twist: FloatArray,
        inputs: Inputs,  # noqa: ARG002 - of the interface
        base: Base,  # noqa: ARG002
    ) -> FloatArray:
        """See `MotionEffect.twist`."""
        k, m = values
        return np.asarray(twist * np.array([k, m, m]))
