"""Treads that follow their commands late."""

from collections.abc import Mapping
from typing import ClassVar

import numpy as np
from scipy.linalg import solve_banded

from odometry.arrays import BoolArray, FloatArray
from odometry.effects.base import CommandEffect, EffectParameter
from odometry.models.inputs import Inputs

LONGEST_STEP_S = 1.0  # after a longer pause the treads have caught up


class ActuatorLag(CommandEffect):
    """A first-order lag between recorded speeds and those of the treads."""

    name = "actuator_lag"
    form = "first_order"
    equation = "lag dv/dt = v_recorded - v"
    source = "first-order lag; recorded speeds are commands"
    looks_like = "errors after every change of speed, none while it is constant"
    alike: ClassVar[Mapping[str, str]] = {
        "time_offset": "gyro_z, which feels the lag and not the stamps of poses"
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
        steps_s = np.diff(inputs.time_s)
        period_s = float(np.median(steps_s[steps_s > 0])) if (steps_s > 0).any() else 1.0
        pause = (steps_s < 0) | (steps_s > max(LONGEST_STEP_S, 2 * period_s))
        starts = np.concatenate([[True], pause])
        held_s = np.where(np.append(pause, True), period_s, np.append(steps_s, 0.0))
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
