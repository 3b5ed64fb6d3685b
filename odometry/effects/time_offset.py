"""Poses whose stamps are late or early."""

from collections.abc import Mapping
from typing import ClassVar

from odometry.arrays import FloatArray
from odometry.effects.base import EffectParameter, MeasurementEffect


class TimeOffset(MeasurementEffect):
    """A pose stamped t was measured at t - offset."""

    name = "time_offset"
    form = "constant"
    equation = "pose(t) -> pose(t - offset); offset > 0: stamps are late"
    source = "definition"
    looks_like = "errors along the path where speed changes, none while it is constant"
    alike: ClassVar[Mapping[str, str]] = {
        "actuator_lag": "gyro_z, which feels the lag and not the stamps of poses"
    }

    @property
    def parameters(self) -> tuple[EffectParameter, ...]:
        """See `Effect.parameters`."""
        return (EffectParameter("offset", "s", -1.0, 1.0, 0.0, 0.02),)

    def delay_s(self, values: FloatArray) -> float:
        """See `MeasurementEffect.delay_s`."""
        return float(values[0])
