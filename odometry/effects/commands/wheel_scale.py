"""Wheels larger or smaller than stated, or treads that slip by a constant share."""

from collections.abc import Mapping
from typing import ClassVar

import numpy as np

from odometry.arrays import FloatArray
from odometry.effects.interface.base import CommandEffect, Effect, EffectParameter
from odometry.effects.interface.in_course import in_course
from odometry.effects.interface.recorded import Recorded
from odometry.effects.interface.time_course import Gradual
from odometry.models.inputs import Inputs

UNIFORM = 0.01  # factors nearer than this are one


class WheelScale(CommandEffect):
    """Each tread moves by a constant factor of what was recorded."""

    name = "wheel_scale"
    form = "factors"
    in_words = "wheels of another size, or constant slip"
    equation = "v_left -> c_l v_left, v_right -> c_r v_right"
    source = "Baril 2020 eq. 7 (alpha); c_l and c_r of Martinez 2024"
    looks_like = "distances too long or short by one share; a drift to one side on straights"
    remedy = "measure the wheels, or take the factors into the model (wheel radius multipliers)"
    alike: ClassVar[Mapping[str, str]] = {
        "traction_loss": "a second measure of tread travel (a motor current, a free wheel): a "
        "uniform factor of both wheels looks like slip"
    }

    def same_as(self, values: FloatArray) -> Mapping[str, str]:
        """See `Effect.same_as`: one factor of both wheels is slip."""
        return self.alike if abs(values[0] - values[1]) < UNIFORM else {}

    @classmethod
    def offered(cls, recorded: Recorded) -> tuple[Effect, ...]:
        """Always, and gradual (tyres that deflate)."""
        return cls(), in_course(cls(), Gradual(recorded.longest_s))

    @property
    def parameters(self) -> tuple[EffectParameter, ...]:
        """See `Effect.parameters`."""
        return (
            EffectParameter("c_l", "", 0.2, 2.0, 1.0, 0.01, 1.0),
            EffectParameter("c_r", "", 0.2, 2.0, 1.0, 0.01, 1.0),
        )

    def tread_speeds(self, values: FloatArray, inputs: Inputs) -> FloatArray:
        """See `CommandEffect.tread_speeds`."""
        return np.asarray(values * inputs.tread_speeds_m_s)
