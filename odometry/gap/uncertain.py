"""What is uncertain of a base: its identified parameters, and a latency of the recording."""

from dataclasses import dataclass, replace

import numpy as np

from odometry.arrays import BoolArray, FloatArray
from odometry.effects.base_model import Base

LONGEST_LATENCY_S = 1.0
PARAMETER_SCALE, LATENCY_SCALE_S = 0.01, 0.02


@dataclass(frozen=True)
class Uncertain:
    """A base, and which of its numbers are free.

    The latency is the delay that robot and recording always have: inertia and drives make every
    robot follow its wheels' record a little late. It is identified with the base, so that it is
    not taken for an effect that is missing.

    Attributes
    ----------
    base : Base
    free : (P,) of bool
        Of the model's parameters.
    latency_is_free : bool
    """

    base: Base
    free: BoolArray
    latency_is_free: bool

    @property
    def values(self) -> FloatArray:
        """The free numbers (F,): parameters, then the latency."""
        latency = [self.base.latency_s] if self.latency_is_free else []
        return np.concatenate([self.base.values[self.free], latency])

    def at(self, values: FloatArray) -> Base:
        """The base with other free numbers (F,)."""
        count = int(self.free.sum())
        parameters = self.base.values.copy()
        parameters[self.free] = values[:count]
        latency_s = float(values[count]) if self.latency_is_free else self.base.latency_s
        return replace(self.base, values=parameters, latency_s=latency_s)

    @property
    def bounds(self) -> tuple[FloatArray, FloatArray]:
        """Least and largest (F,)."""
        searched = [p.search or (p.low, p.high) for p in self.base.model.parameters]
        latency = [(-LONGEST_LATENCY_S, LONGEST_LATENCY_S)] if self.latency_is_free else []
        ends = [s for s, free in zip(searched, self.free, strict=True) if free] + latency
        low, high = np.array(ends, dtype=np.float64).reshape(-1, 2).T
        return np.asarray(low), np.asarray(high)

    @property
    def scales(self) -> FloatArray:
        """Small changes (F,) that matter."""
        latency = [LATENCY_SCALE_S] if self.latency_is_free else []
        return np.concatenate([np.full(int(self.free.sum()), PARAMETER_SCALE), latency])
