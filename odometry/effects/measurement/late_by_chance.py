"""Poses that are stamped when they arrive, some later than others."""

from collections.abc import Mapping
from typing import ClassVar

import numpy as np

from odometry.arrays import FloatArray
from odometry.effects.commands.late_treads import BY_GYROSCOPE
from odometry.effects.interface.base import Effect, EffectParameter, MeasurementEffect
from odometry.effects.interface.recorded import Recorded
from odometry.effects.measurement.pose_stamps import uneven_s

EARLY_S = 0.02  # mean of the stamps, from which they are early, or all late
LEAST_S = 0.01  # standard deviation of stamps about even ones
LEAST_SHARE = 0.75  # of what stamps are uneven by: of poses that were measured evenly it is all


class LateByChance(MeasurementEffect):
    """Poses are measured evenly and stamped later by chance: their stamps say by how much.

    Nothing that a robot does follows the chance of its stamps.
    """

    name = "reference_fault"
    form = "late_by_chance"
    in_words = "poses that are stamped when they arrive, some later than others"
    equation = "pose(t) -> pose(t - offset - share (t - even t))"
    source = "definition"
    looks_like = "steps between poses that are uneven in time and even in distance"
    remedy = "stamp poses when they are measured, not when they arrive"
    needs = "poses whose stamps are uneven"
    of_reference = True
    essential = ("share",)
    always = (1.0, 0.0)
    alike: ClassVar[Mapping[str, str]] = {"command_delay": BY_GYROSCOPE}

    @classmethod
    def offered(cls, recorded: Recorded) -> tuple[Effect, ...]:
        """Where the stamps of poses are uneven."""
        spreads_s = [float(np.std(uneven_s(of.stamps_s))) for of in recorded.reported]
        return (cls(),) if max(spreads_s, default=0.0) > LEAST_S else ()

    @property
    def parameters(self) -> tuple[EffectParameter, ...]:
        """See `Effect.parameters`; `share` is 1 where poses were measured evenly."""
        return (
            EffectParameter("share", "", -1.0, 2.0, 0.0, 0.02),
            EffectParameter("offset", "s", -1.0, 1.0, 0.0, 0.02),
        )

    def in_words_at(self, values: FloatArray) -> str:
        """See `Effect.in_words_at`: stamps that are cut to a coarse step are early."""
        if values[1] < -EARLY_S:
            return "poses whose stamps are early, some by more than others (cut to a coarse step)"
        late = "all late, some" if values[1] > EARLY_S else "some"
        return self.in_words.replace("some", late)

    def is_meant(self, values: FloatArray) -> bool:
        """See `Effect.is_meant`: uneven stamps are late, not measured so; not half of both."""
        return bool(values[0] > LEAST_SHARE)

    def delay_s(
        self,
        values: FloatArray,
        stamps_s: FloatArray,
        run: int | None = None,  # noqa: ARG002 - of the interface
    ) -> FloatArray:
        """See `MeasurementEffect.delay_s`."""
        return np.asarray(values[1] + values[0] * uneven_s(stamps_s))
