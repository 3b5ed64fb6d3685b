"""What a kinematic model is told: tread speeds, attitude, accelerations."""

from dataclasses import dataclass, field

import numpy as np

from odometry.arrays import FloatArray, IntArray


def _level() -> FloatArray:
    return np.zeros(())


@dataclass(frozen=True)
class Inputs:
    """Measured inputs of a model, one sample or a stack of them; all are broadcast to one stack.

    Attributes
    ----------
    tread_speeds_m_s : (..., 2)
        v_left, v_right, before any slip.
    roll_rad, pitch_rad : (...)
        REP-103: roll > 0 has the right side down, pitch > 0 the nose. Level ground where absent.
    accelerations_m_s2 : (..., 2) or None
        accel_x, accel_y as an accelerometer at the robot's origin reads them, gravity included;
        None where they were not recorded.
    """

    tread_speeds_m_s: FloatArray
    roll_rad: FloatArray = field(default_factory=_level)
    pitch_rad: FloatArray = field(default_factory=_level)
    accelerations_m_s2: FloatArray | None = None

    def __post_init__(self) -> None:
        speeds = np.asarray(self.tread_speeds_m_s)
        stack = np.broadcast_shapes(
            speeds.shape[:-1], np.shape(self.roll_rad), np.shape(self.pitch_rad)
        )
        object.__setattr__(self, "tread_speeds_m_s", np.broadcast_to(speeds, (*stack, 2)))
        object.__setattr__(self, "roll_rad", np.broadcast_to(self.roll_rad, stack))
        object.__setattr__(self, "pitch_rad", np.broadcast_to(self.pitch_rad, stack))

    @property
    def left(self) -> FloatArray:
        """v_left (...)."""
        return self.tread_speeds_m_s[..., 0]

    @property
    def right(self) -> FloatArray:
        """v_right (...)."""
        return self.tread_speeds_m_s[..., 1]

    @property
    def shape(self) -> tuple[int, ...]:
        """Shape of the stack, () for one sample."""
        return self.roll_rad.shape

    def rows(self, chosen: slice | IntArray) -> "Inputs":
        """Some samples of a stack (N, ...)."""
        return Inputs(
            self.tread_speeds_m_s[chosen],
            self.roll_rad[chosen],
            self.pitch_rad[chosen],
            None if self.accelerations_m_s2 is None else self.accelerations_m_s2[chosen],
        )
