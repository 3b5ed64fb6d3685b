"""Treads that follow their commands after a dead time."""

from collections.abc import Mapping
from typing import ClassVar

import numpy as np

from odometry.arrays import FloatArray
from odometry.effects.base import CommandEffect, EffectParameter
from odometry.effects.held_commands import held_spans
from odometry.effects.time_offset import BY_GYROSCOPE
from odometry.models.inputs import Inputs


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

    def tread_speeds(self, values: FloatArray, inputs: Inputs) -> FloatArray:
        """See `CommandEffect.tread_speeds`; the mean over each sample, exact for held commands.

        Before the first sample of a record its speed was held.
        """
        if inputs.time_s is None or not values[0]:
            return inputs.tread_speeds_m_s
        speeds = np.array(inputs.tread_speeds_m_s, dtype=np.float64)
        held_s, starts = held_spans(inputs.time_s)
        for rows in np.split(np.arange(len(speeds)), np.flatnonzero(starts)[1:]):
            speeds[rows] = _late(speeds[rows], held_s[rows], float(values[0]))
        return speeds


def _late(speeds: FloatArray, held_s: FloatArray, delay_s: float) -> FloatArray:
    """Mean speeds (N, 2) of one record, late: differences of its travel."""
    ends_s = np.concatenate([[0.0], np.cumsum(held_s)])
    first = ends_s[0] - delay_s
    moved = held_s > 0
    late = speeds.copy()
    for tread in (0, 1):
        travel_m = np.concatenate([[0.0], np.cumsum(speeds[:, tread] * held_s)])
        at_m = np.interp(
            ends_s - delay_s,
            np.concatenate([[first], ends_s]),
            np.concatenate([[-delay_s * speeds[0, tread]], travel_m]),
        )
        late[moved, tread] = (np.diff(at_m) / np.where(moved, held_s, 1.0))[moved]
    return late
