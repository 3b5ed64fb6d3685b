"""What is uncertain of a base: its identified parameters, and a latency of the recording."""

from dataclasses import dataclass, replace

import numpy as np

from odometry.arrays import BoolArray, FloatArray
from odometry.effects.base_model import Base

LONGEST_LATENCY_S = 1.0
LARGEST_BIAS_RAD_S = 0.5
PARAMETER_SCALE, LATENCY_SCALE_S, BIAS_SCALE_RAD_S = 0.01, 0.02, 1e-3


@dataclass(frozen=True)
class Uncertain:
    """A base, and which of its numbers are free.

    The latency is the delay that robot and recording always have: inertia and drives make every
    robot follow its wheels' record a little late. It is identified with the base, so that it is
    not taken for an effect that is missing. A gyroscope has its own latency: it measures what
    the drives do late, and not what the stamps of poses are late.

    Attributes
    ----------
    base : Base
    free : (P,) of bool
        Of the model's parameters.
    latency_is_free : bool
    has_gyroscope : bool
        Whether a gyroscope was recorded, whose own latency and bias are free then.
    """

    base: Base
    free: BoolArray
    latency_is_free: bool
    has_gyroscope: bool = False

    @property
    def values(self) -> FloatArray:
        """The free numbers (F,): parameters, the latency, then those of the gyroscope."""
        latency = [self.base.latency_s] if self.latency_is_free else []
        own = [self.base.gyro_latency_s, self.base.gyro_bias_rad_s] if self.has_gyroscope else []
        return np.concatenate([self.base.values[self.free], latency, own])

    @property
    def names(self) -> tuple[str, ...]:
        """Of the free numbers."""
        parameters = zip(self.base.model.parameters, self.free, strict=True)
        return (
            *(parameter.name for parameter, free in parameters if free),
            *(("latency",) if self.latency_is_free else ()),
            *(("gyro_latency", "gyro_bias") if self.has_gyroscope else ()),
        )

    def at(self, values: FloatArray) -> Base:
        """The base with other free numbers (F,)."""
        count = int(self.free.sum())
        parameters = self.base.values.copy()
        parameters[self.free] = values[:count]
        latency_s = float(values[count]) if self.latency_is_free else self.base.latency_s
        moved = replace(self.base, values=parameters, latency_s=latency_s)
        if not self.has_gyroscope:
            return moved
        return replace(moved, gyro_latency_s=float(values[-2]), gyro_bias_rad_s=float(values[-1]))

    @property
    def bounds(self) -> tuple[FloatArray, FloatArray]:
        """Least and largest (F,)."""
        searched = [p.search or (p.low, p.high) for p in self.base.model.parameters]
        late = (-LONGEST_LATENCY_S, LONGEST_LATENCY_S)
        ends = [s for s, free in zip(searched, self.free, strict=True) if free]
        ends += [late] if self.latency_is_free else []
        ends += [late, (-LARGEST_BIAS_RAD_S, LARGEST_BIAS_RAD_S)] if self.has_gyroscope else []
        low, high = np.array(ends, dtype=np.float64).reshape(-1, 2).T
        return np.asarray(low), np.asarray(high)

    @property
    def scales(self) -> FloatArray:
        """Small changes (F,) that matter."""
        latency = [LATENCY_SCALE_S] if self.latency_is_free else []
        own = [LATENCY_SCALE_S, BIAS_SCALE_RAD_S] if self.has_gyroscope else []
        return np.concatenate([np.full(int(self.free.sum()), PARAMETER_SCALE), latency, own])
