"""A gyroscope that reports another yaw rate than the robot has."""

import numpy as np

from odometry.arrays import FloatArray
from odometry.effects.interface.base import EffectParameter, MeasurementEffect
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
    moves_poses = False

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


class GyroscopeBySpeedError(GyroscopeError):
    """The reported yaw rate is off by more the faster the treads run: vibration is rectified."""

    form = "by_speed"
    in_words = "a gyroscope whose bias grows with the speed"
    equation = "w -> w + linear |f| + square f^2 + turning d^2, f and d half of v_r +/- v_l"
    looks_like = "a gyroscope that reports a turn on straight lines, more of it at speed"
    remedy = "damp the mount of the gyroscope, or estimate its bias while driving"

    @property
    def parameters(self) -> tuple[EffectParameter, ...]:
        """See `Effect.parameters`."""
        return (
            EffectParameter("linear", "rad/m", -5.0, 5.0, 0.0, 0.005),
            EffectParameter("square", "rad s/m^2", -5.0, 5.0, 0.0, 0.005),
            EffectParameter("turning", "rad s/m^2", -5.0, 5.0, 0.0, 0.005),
        )

    def gyroscope(
        self, values: FloatArray, yaw_rate_rad_s: FloatArray, inputs: Inputs
    ) -> FloatArray:
        """See `MeasurementEffect.gyroscope`."""
        forward_m_s = np.abs(inputs.left + inputs.right) / 2
        apart_m_s = (inputs.right - inputs.left) / 2
        grown = [forward_m_s, forward_m_s**2, apart_m_s**2]
        return np.asarray(yaw_rate_rad_s + np.tensordot(values, grown, axes=1))
