"""Treads that follow their commands late: gradually, or after a dead time."""

from collections.abc import Mapping
from typing import ClassVar

import numpy as np
from scipy.linalg import solve_banded

from odometry.arrays import BoolArray, FloatArray
from odometry.effects.commands.held_commands import held_spans, late_speeds
from odometry.effects.interface.base import CommandEffect, EffectParameter
from odometry.models.inputs import Inputs

BY_GYROSCOPE = "gyro_z, which follows the motion and not the stamps of poses"

SLIP_BY_FORCE = (
    "measured wheel speeds: a late tread turns late, and one that slips in proportion to its force "
    "turns in time"
)

BY_STEPS = "commands that change in steps: a delay moves the answer, a lag rounds it"


class ActuatorLag(CommandEffect):
    """A first-order lag between recorded speeds and those of the treads."""

    name = "actuator_lag"
    form = "first_order"
    in_words = "drives that follow their commands slowly"
    equation = "lag dv/dt = v_recorded - v"
    source = "first-order lag; recorded speeds are commands"
    looks_like = "errors after every change of speed, none while it is constant"
    remedy = "record measured wheel speeds, or keep the lag in the model"
    alike: ClassVar[Mapping[str, str]] = {
        "time_offset": BY_GYROSCOPE,
        "command_delay": BY_STEPS,
    }

    @property
    def parameters(self) -> tuple[EffectParameter, ...]:
        """See `Effect.parameters`."""
        return (EffectParameter("lag", "s", 0.0, 2.0, 0.1, 0.02),)

    def tread_speeds(self, values: FloatArray, inputs: Inputs) -> FloatArray:
        """See `CommandEffect.tread_speeds`; the mean over each sample, exact for held commands."""
        speeds = inputs.tread_speeds_m_s
        lag = float(values[0])
        if inputs.time_s is None or lag <= 0 or len(speeds) < 2:
            return speeds
        held_s, starts = held_spans(inputs.time_s)
        return _means_of_lagged(speeds, held_s / lag, starts)


def _means_of_lagged(speeds: FloatArray, spans: FloatArray, starts: BoolArray) -> FloatArray:
    """Mean speeds (N, 2) of treads that follow held commands (N, 2).

    Parameters
    ----------
    speeds : (N, 2)
    spans : (N,)
        How long each command is held, in lags.
    starts : (N,)
        Where the treads have caught up with the command before it begins.
    """
    decay = np.where(starts, 0.0, np.exp(-spans))
    recursion = np.stack([np.ones(len(speeds)), np.append(-decay[1:], 0.0)])
    reached = solve_banded((1, 0), recursion, (1 - decay)[:, None] * speeds)
    before = np.where(starts[:, None], speeds, np.roll(reached, 1, axis=0))
    shares = np.divide(-np.expm1(-spans), spans, out=np.ones_like(spans), where=spans > 0)
    return np.asarray(speeds + (before - speeds) * shares[:, None])


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
        "actuator_lag": BY_STEPS,
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
