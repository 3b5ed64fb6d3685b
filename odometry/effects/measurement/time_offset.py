"""Poses whose stamps are late or early, by a constant or more and more."""

from collections.abc import Mapping
from typing import ClassVar

import numpy as np

from odometry.arrays import FloatArray
from odometry.effects.commands.late_treads import BY_GYROSCOPE
from odometry.effects.interface.base import Effect, EffectParameter, MeasurementEffect
from odometry.effects.interface.recorded import Recorded, Reported
from odometry.windows.recorded.measured_poses import positions_at


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


class LatePositions(MeasurementEffect):
    """Stamps of positions that are late, where the yaw was found from these.

    From one position to the next such a yaw follows the gyroscope, whose stamps are right: it is
    not late. Where it follows the treads, commands that act late look the same.
    """

    name = "time_offset"
    form = "of_positions"
    in_words = "stamps of positions that are late or early"
    equation = "(x, y)(t) -> (x, y)(t - offset); offset > 0: stamps are late"
    source = "definition"
    looks_like = "a robot at the position of a moment ago, with the heading of now"
    remedy = "synchronise the clocks, or move the stamps of the positions by the offset"
    needs = "a yaw that was found from positions and a gyroscope"
    of_reference = True
    by_pose = False
    alike: ClassVar[Mapping[str, str]] = TimeOffset.alike

    @classmethod
    def offered(cls, recorded: Recorded) -> tuple[Effect, ...]:
        """Where the yaw of each run was found by a gyroscope."""
        found = [of.yaw_is_found for of in recorded.reported]
        return (cls(),) if found and all(found) else ()

    @property
    def parameters(self) -> tuple[EffectParameter, ...]:
        """See `Effect.parameters`."""
        return (EffectParameter("offset", "s", -1.0, 1.0, 0.1, 0.02),)

    def seen(self, values: FloatArray, poses: FloatArray, reported: Reported) -> FloatArray:
        """See `MeasurementEffect.seen`; held beyond the ends of a run."""
        positions = positions_at(reported.stamps_s - values[0], reported.stamps_s, poses)
        return np.concatenate([positions, poses[:, 2:]], axis=1)


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
