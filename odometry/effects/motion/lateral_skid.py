"""A robot that turns about a point further ahead or behind than in the model."""

from collections.abc import Mapping
from typing import ClassVar

import numpy as np

from odometry.arrays import FloatArray
from odometry.effects.interface.base import EffectParameter, MotionEffect
from odometry.effects.interface.base_model import Base
from odometry.models.inputs import Inputs

DISTINGUISHED_BY = (
    "a second pose sensor at another place on the robot, or its place measured with a tape: from "
    "one measured pose both look exactly the same"
)


class LateralSkid(MotionEffect):
    """The forward place that both tread ICRs share is shifted."""

    name = "lateral_skid"
    form = "x_icr"
    in_words = "turning about a point further ahead or behind"
    equation = "v_y -> v_y - x_shift omega"
    source = "Baril 2020 eq. 7, Chen 2023 eq. 3"
    looks_like = "sideways motion in turns, to opposite sides in left and right turns"
    remedy = "keep the shift in the model; see whether the load has moved"
    alike: ClassVar[Mapping[str, str]] = {"lever_arm": DISTINGUISHED_BY}

    def same_as(self, values: FloatArray) -> Mapping[str, str]:  # noqa: ARG002 - of the interface
        """See `Effect.same_as`."""
        return {"lever_arm": DISTINGUISHED_BY}

    @property
    def parameters(self) -> tuple[EffectParameter, ...]:
        """See `Effect.parameters`."""
        return (EffectParameter("x_shift", "m", -2.0, 2.0, 0.0, 0.01),)

    def twist(
        self,
        values: FloatArray,
        twist: FloatArray,
        inputs: Inputs,  # noqa: ARG002 - of the interface
        base: Base,  # noqa: ARG002
    ) -> FloatArray:
        """See `MotionEffect.twist`."""
        shifted = twist.copy()
        shifted[:, 1] -= values[0] * twist[:, 2]
        return np.asarray(shifted)
