"""Faults of drives that each tread has by itself: one may be slow, late, weak or limited alone."""

from dataclasses import replace

import numpy as np

from odometry.arrays import FloatArray
from odometry.effects.commands.drive_limit import HARDEST_M_S2, Deadband, RateLimit, Saturation
from odometry.effects.commands.late_treads import ActuatorLag, CommandDelay
from odometry.effects.interface.base import CommandEffect, Effect, EffectParameter
from odometry.effects.interface.base_model import Base
from odometry.effects.interface.recorded import Recorded
from odometry.models.inputs import Inputs

SIDES = ("left", "right")
LEAST_APART = 0.2  # share of the larger by which the numbers of both treads differ


class BySide(CommandEffect):
    """An effect on commands of one number, with a number for each tread.

    Beside the form of one number for both it is another form of the same name, and its
    second number costs evidence.
    """

    looks_like = "turns to one side that were not commanded, where this tread has its fault"
    _of: type[CommandEffect]

    def __init__(self, of_both: CommandEffect | None = None) -> None:
        self.of_both = of_both or self._of()

    @classmethod
    def offered(cls, recorded: Recorded) -> tuple[Effect, ...]:
        """As the effect of both is."""
        offered = cls._of.offered(recorded)
        return tuple(cls(one) for one in offered if isinstance(one, CommandEffect))

    def __init_subclass__(cls, of: type[CommandEffect]) -> None:
        super().__init_subclass__()
        cls._of = of
        cls.name, cls.in_words, cls.remedy = of.name, of.in_words, of.remedy
        cls.equation, cls.source = f"{of.equation}, of each tread", of.source
        cls.needs, cls.alike = of.needs, of.alike

    @property
    def parameters(self) -> tuple[EffectParameter, ...]:
        """See `Effect.parameters`: that of the left tread, then that of the right one."""
        (p,) = self.of_both.parameters
        return tuple(replace(p, name=f"{p.name}_{side}") for side in SIDES)

    def starts(self, inputs: Inputs, base: Base) -> FloatArray:
        """See `Effect.starts`: each of the effect on the left alone, the right alone, and both."""
        one = self.of_both.starts(inputs, base)[:, 0]
        none = np.full_like(one, self.parameters[0].absent)
        both = one[[len(one) // 2]]
        pairs = ((one, none), (none, one), (both, both))
        return np.vstack([np.stack(pair, axis=-1) for pair in pairs])

    def resolution(self, values: FloatArray, inputs: Inputs) -> FloatArray:
        """See `Effect.resolution`."""
        return np.concatenate(
            [
                self.of_both.resolution(values[[side]], _alone(inputs, side))
                for side in range(len(SIDES))
            ]
        )

    def is_meant(self, values: FloatArray) -> bool:
        """See `Effect.is_meant`: nearly the same of both treads is no fault of one side."""
        left, right = self._sizes(values)
        return bool(abs(left - right) > LEAST_APART * max(left, right))

    def in_words_at(self, values: FloatArray) -> str:
        """See `Effect.in_words_at`: which tread has the fault, where it is one alone."""
        acts = (self._sizes(values) > [p.scale for p in self.parameters]).tolist()
        if all(acts) or not any(acts):
            return f"{self.in_words}, each side by itself"
        return f"{self.in_words}, on the {SIDES[acts.index(True)]} alone"

    def tread_speeds(self, values: FloatArray, inputs: Inputs) -> FloatArray:
        """See `CommandEffect.tread_speeds`."""
        speeds = inputs.tread_speeds_m_s.astype(np.float64)
        for side, parameter in enumerate(self.parameters):
            if values[side] != parameter.absent:
                speeds[:, side] = self.of_both.tread_speeds(values[[side]], _alone(inputs, side))[
                    :, 0
                ]
        return speeds

    def _sizes(self, values: FloatArray) -> FloatArray:
        """How much there is of it (2,), by the distance of each number from none."""
        return np.abs(values - [p.absent for p in self.parameters])


def _alone(inputs: Inputs, side: int) -> Inputs:
    """The inputs with the speeds of one tread (N, 1)."""
    return replace(inputs, tread_speeds_m_s=inputs.tread_speeds_m_s[:, [side]])


class LagBySide(BySide, of=ActuatorLag):
    """A first-order lag of each tread's own."""

    form = "first_order_by_side"


class DelayBySide(BySide, of=CommandDelay):
    """A dead time of each tread's own."""

    form = "by_side"


class DeadbandBySide(BySide, of=Deadband):
    """A deadband of each tread's own."""

    form = "deadband_by_side"


class SaturationBySide(BySide, of=Saturation):
    """A highest speed of each tread's own."""

    form = "saturation_by_side"


class RateBySide(BySide, of=RateLimit):
    """A highest change of speed of each tread's own; one that is not reached is none."""

    form = "rate_by_side"

    @property
    def parameters(self) -> tuple[EffectParameter, ...]:
        """See `Effect.parameters`: at the hardest that is searched a tread follows at once."""
        return tuple(replace(p, absent=HARDEST_M_S2) for p in super().parameters)

    def _sizes(self, values: FloatArray) -> FloatArray:
        """How long (2,) a change of speed takes, beyond that of a tread without limit [s^2/m]."""
        return np.asarray(1 / values - 1 / HARDEST_M_S2)
