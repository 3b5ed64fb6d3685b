"""Poses whose stamps are late or early, by a constant or more and more."""

from collections.abc import Mapping
from typing import ClassVar

import numpy as np

from odometry.arrays import FloatArray
from odometry.effects.commands.late_treads import BY_GYROSCOPE
from odometry.effects.interface.base import EffectParameter, MeasurementEffect


class TimeOffset(MeasurementEffect):
    """A pose stamped t was measured at t - offset."""

    name = "time_offset"
    form = "constant"
    in_words = "pose stamps that are late or early"
    equation = "pose(t) -> pose(t - offset); offset > 0: stamps are late"
    source = "definition"
    looks_like = "errors along the path where speed changes, none while it is constant"
    remedy = "synchronise the clocks, or move the stamps of the poses by the offset"
    of_reference = True
    alike: ClassVar[Mapping[str, str]] = {
        "actuator_lag": BY_GYROSCOPE,
        "command_delay": BY_GYROSCOPE,
    }

    @property
    def parameters(self) -> tuple[EffectParameter, ...]:
        """See `Effect.parameters`."""
        return (EffectParameter("offset", "s", -1.0, 1.0, 0.0, 0.02),)

    def delay_s(
        self,
        values: FloatArray,
        stamps_s: FloatArray,
        run: int | None = None,  # noqa: ARG002 - of the interface
    ) -> FloatArray:
        """See `MeasurementEffect.delay_s`."""
        return np.full_like(stamps_s, values[0])


class ClockDrift(MeasurementEffect):
    """The clock of the poses runs fast or slow."""

    name = "time_offset"
    form = "drift"
    in_words = "a clock of the poses that runs fast or slow"
    equation = "pose(t) -> pose(t - offset - rate t); rate > 0: the clock is fast"
    source = "definition"
    looks_like = "errors along the path where speed changes, that grow over the run"
    remedy = "synchronise the clocks, or divide the stamps of the poses by 1 + rate"
    of_reference = True
    includes: ClassVar[Mapping[str, str]] = {"command_delay": BY_GYROSCOPE}

    @property
    def parameters(self) -> tuple[EffectParameter, ...]:
        """See `Effect.parameters`; `offset` is that at the start of a run.

        A clock that is off by a hundredth is none: a scale of all speeds looks the same.
        """
        return (
            EffectParameter("offset", "s", -1.0, 1.0, 0.0, 0.02),
            EffectParameter("rate", "", -0.01, 0.01, 0.0, 1e-4),
        )

    def delay_s(
        self,
        values: FloatArray,
        stamps_s: FloatArray,
        run: int | None = None,  # noqa: ARG002 - of the interface
    ) -> FloatArray:
        """See `MeasurementEffect.delay_s`."""
        return np.asarray(values[0] + values[1] * stamps_s)
