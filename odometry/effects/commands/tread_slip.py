"""Slip of a tread that depends on its own motion."""

import numpy as np

from odometry.arrays import FloatArray
from odometry.effects.commands.held_commands import held_spans
from odometry.effects.interface.base import CommandEffect, Effect, EffectParameter
from odometry.effects.interface.recorded import Recorded
from odometry.models.inputs import Inputs

SMOOTHED_S = 0.2  # over which the acceleration of a tread is taken


class TreadSlip(CommandEffect):
    """Shared by all: the same law for both treads, each by its own speed."""

    name = "tread_slip"
    source = "longitudinal slip as a share of the tread's speed: Wong, Theory of Ground Vehicles"
    remedy = "keep it in the model, or drive at even speed"


class SlipBySpeed(TreadSlip):
    """A share of the speed is lost that grows with the speed.

    Parameters
    ----------
    fastest_m_s : float
        At which all of the speed may be lost.
    """

    form = "by_speed"
    in_words = "slip that grows with the speed of a tread"
    equation = "v -> v (1 - growth |v|)"
    looks_like = "fast stretches that come out short"
    needs = "stretches at different speeds"

    def __init__(self, fastest_m_s: float = 1.0) -> None:
        self.fastest_m_s = fastest_m_s

    @classmethod
    def offered(cls, recorded: Recorded) -> tuple[Effect, ...]:
        """Of slow robots at the fastest speed recorded."""
        return (cls(min(recorded.fastest_m_s, 1.0) or 1.0),)

    @property
    def parameters(self) -> tuple[EffectParameter, ...]:
        """See `Effect.parameters`."""
        most = 1 / self.fastest_m_s
        return (EffectParameter("growth", "s/m", -most, most, 0.0, 0.01),)

    def is_meant(self, values: FloatArray) -> bool:
        """See `Effect.is_meant`: slip is no gain, as of an encoder that loses counts."""
        return bool(values[0] >= 0.0)

    def tread_speeds(self, values: FloatArray, inputs: Inputs) -> FloatArray:
        """See `CommandEffect.tread_speeds`."""
        speeds = inputs.tread_speeds_m_s
        return np.asarray(speeds * (1 - values[0] * np.abs(speeds)))


class SlipByDirection(TreadSlip):
    """A tread that turns backward slips by another share than one that turns forward."""

    form = "by_direction"
    in_words = "slip that differs forward and backward"
    equation = "v -> c_backward v where v < 0"
    looks_like = "distances that fit forward and not backward, spins about a point aside"
    needs = "treads that turn forward and backward"

    @property
    def parameters(self) -> tuple[EffectParameter, ...]:
        """See `Effect.parameters`."""
        return (EffectParameter("c_backward", "", 0.2, 2.0, 1.0, 0.01, 1.0),)

    def tread_speeds(self, values: FloatArray, inputs: Inputs) -> FloatArray:
        """See `CommandEffect.tread_speeds`."""
        speeds = inputs.tread_speeds_m_s
        return np.where(speeds < 0, values[0] * speeds, speeds)


class SlipByAcceleration(TreadSlip):
    """A share of the speed is lost that grows with how hard a tread speeds up."""

    form = "by_acceleration"
    in_words = "slip where a tread speeds up or brakes"
    equation = "v -> v (1 - growth d|v|/dt)"
    looks_like = "errors while speed changes, of one sign in starts and of the other in stops"
    needs = "starts and stops"

    @property
    def parameters(self) -> tuple[EffectParameter, ...]:
        """See `Effect.parameters`."""
        return (EffectParameter("growth", "s^2/m", -2.0, 2.0, 0.0, 0.02),)

    def is_meant(self, values: FloatArray) -> bool:
        """See `Effect.is_meant`: treads that slip are behind in starts, and not ahead."""
        return bool(values[0] >= 0.0)

    def tread_speeds(self, values: FloatArray, inputs: Inputs) -> FloatArray:
        """See `CommandEffect.tread_speeds`; the acceleration is a difference over 0.2 s."""
        speeds = inputs.tread_speeds_m_s
        if inputs.time_s is None:
            return speeds
        held_s, starts = held_spans(inputs.time_s)
        middle_s = np.cumsum(held_s) - held_s / 2
        changed = np.empty_like(speeds)
        for rows in np.split(np.arange(len(speeds)), np.flatnonzero(starts)[1:]):
            at_s, size = middle_s[rows], np.abs(speeds[rows])
            for tread in (0, 1):
                ahead, behind = (
                    np.interp(at_s + side * SMOOTHED_S / 2, at_s, size[:, tread])
                    for side in (1, -1)
                )
                changed[rows, tread] = (ahead - behind) / SMOOTHED_S
        return np.asarray(speeds * np.clip(1 - values[0] * changed, 0.0, 2.0))


class SlipOfOneTread(TreadSlip):
    """One tread loses a share of its speed; always there it is a wheel of another size."""

    equation = "v -> kept v, of one tread"
    looks_like = "sudden turns to one side, while both treads run as before"
    remedy = "look at this tread, its brake and its track at these times"
    side: int

    @property
    def parameters(self) -> tuple[EffectParameter, ...]:
        """See `Effect.parameters`."""
        return (EffectParameter("kept", "", 0.0, 1.5, 1.0, 0.01, 1.0),)

    @classmethod
    def offered(cls, recorded: Recorded) -> tuple[Effect, ...]:  # noqa: ARG003 - of the interface
        """None: its events are searched where nothing that lasts explains the gap."""
        return ()

    def is_meant(self, values: FloatArray) -> bool:
        """Slip is no gain."""
        return bool(values[0] <= 1.0)

    def tread_speeds(self, values: FloatArray, inputs: Inputs) -> FloatArray:
        """See `CommandEffect.tread_speeds`."""
        factors = np.where(np.arange(2) == self.side, values[0], 1.0)
        return np.asarray(inputs.tread_speeds_m_s * factors)


class SlipOfLeftTread(SlipOfOneTread):
    """See `SlipOfOneTread`."""

    form = "left_tread"
    in_words = "slip of the left tread"
    side = 0


class SlipOfRightTread(SlipOfOneTread):
    """See `SlipOfOneTread`."""

    form = "right_tread"
    in_words = "slip of the right tread"
    side = 1
