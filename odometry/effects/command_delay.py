"""Treads that follow their commands after a dead time."""

from collections.abc import Mapping
from typing import ClassVar

from odometry.arrays import FloatArray
from odometry.effects.base import CommandEffect, EffectParameter
from odometry.effects.held_commands import held_spans, late_speeds
from odometry.effects.time_offset import BY_GYROSCOPE
from odometry.models.inputs import Inputs

SLIP_BY_FORCE = (
    "measured wheel speeds: a late tread turns late, and one that slips in proportion to its force "
    "turns in time"
)


class CommandDelay(CommandEffect):
    """The treads do at t what was recorded for t - delay."""

    name = "command_delay"
    form = "constant"
    in_words = "commands that act late"
    equation = "v(t) -> v_recorded(t - delay)"
    source = "definition; recorded speeds are commands"
    looks_like = "errors after every change of speed, none while it is constant"
    remedy = "record measured wheel speeds, or move the stamps of the commands by the delay"
    alike: ClassVar[Mapping[str, str]] = {
        "time_offset": BY_GYROSCOPE,
        "actuator_lag": "commands that change in steps: a delay moves the answer, a lag rounds it",
    }

    @property
    def parameters(self) -> tuple[EffectParameter, ...]:
        """See `Effect.parameters`."""
        return (EffectParameter("delay", "s", 0.0, 1.0, 0.05, 0.02),)

    def same_as(self, values: FloatArray) -> Mapping[str, str]:  # noqa: ARG002 - of the interface
        """See `Effect.same_as`: v(t - delay) is v - delay dv/dt to first order."""
        return {"tread_slip": SLIP_BY_FORCE}

    def tread_speeds(self, values: FloatArray, inputs: Inputs) -> FloatArray:
        """See `CommandEffect.tread_speeds`; the mean over each sample, exact for held commands.

        Before the first sample of a record its speed was held.
        """
        if inputs.time_s is None or not values[0]:
            return inputs.tread_speeds_m_s
        held_s, starts = held_spans(inputs.time_s)
        return late_speeds(inputs.tread_speeds_m_s, held_s, starts, float(values[0]))
