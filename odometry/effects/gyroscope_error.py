"""A gyroscope that reports another yaw rate than the robot has."""

import numpy as np

from odometry.arrays import FloatArray
from odometry.effects.base import EffectParameter, MeasurementEffect
from odometry.models.inputs import Inputs


class GyroscopeError(MeasurementEffect):
    """The reported yaw rate is scaled, and drifts; a constant bias is estimated in any case."""

    name = "gyroscope_error"
    form = "scale_drift"
    in_words = "a gyroscope whose scale is wrong or whose bias drifts"
    equation = "w -> scale w + drift t"
    source = "definition"
    looks_like = "a gyroscope that contradicts both the poses and the treads in every turn"
    remedy = "calibrate the gyroscope, or leave it out (the poses and the treads agree)"
    needs = "a gyroscope and a measured pose"
    of_reference = True

    @property
    def parameters(self) -> tuple[EffectParameter, ...]:
        """See `Effect.parameters`."""
        return (
            EffectParameter("scale", "", -2.0, 100.0, 1.0, 0.01, 1.0),
            EffectParameter("drift", "rad/s^2", -0.01, 0.01, 0.0, 1e-4),
        )

    def lacks(self, inputs: Inputs, base: object) -> str:  # noqa: ARG002 - of the interface
        """See `Effect.lacks`."""
        return "" if inputs.yaw_rate_rad_s is not None else "a gyroscope"

    def gyroscope(
        self, values: FloatArray, yaw_rate_rad_s: FloatArray, inputs: Inputs
    ) -> FloatArray:
        """See `MeasurementEffect.gyroscope`."""
        time_s = 0.0 if inputs.time_s is None else inputs.time_s
        return np.asarray(values[0] * yaw_rate_rad_s + values[1] * time_s)
