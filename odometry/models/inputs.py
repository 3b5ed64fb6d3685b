"""Inputs of a kinematic model: tread speeds, attitude, accelerations."""

from collections.abc import Sequence
from dataclasses import dataclass, field, fields
from functools import cached_property
from typing import Any

import numpy as np

from odometry.arrays import AnyArray, FloatArray, IntArray
from odometry.geometry.tilt import Tilt, tilt_of


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
    time_s : (...) or None
        Run time: since the first stamp of odometry.csv.
    terrain : (...) of str or None
        Name of the terrain.
    heading_rad : (...) or None
        Measured yaw, interpolated and not wrapped; None without measured poses.
    wheel_angles_rad : (..., 2) or None
        Turned since the start, left and right; None where the wheel radius is not stated.
    yaw_rate_rad_s : (...) or None
        Of a gyroscope less its bias, for programs that integrate the yaw with it; no model uses it.
    run_number : (...) of int or None
        Which of several runs a sample is of, from 0; that of one run where absent.
    position_m : (..., 2) or None
        Measured x and y, in the frame of the reference, interpolated; None without measured poses.
    unrepeated_m_s : (..., 2) or None
        What lines between new values add to tread speeds that are repeated
        (`odometry.recording.repeated_speeds`); None where none is.

    Examples
    --------
    >>> import numpy as np
    >>> import odometry
    >>> level = odometry.Inputs(np.array([[0.5, 0.5], [0.4, 0.6]]))
    >>> level.roll_rad.tolist()
    [0.0, 0.0]
    """

    tread_speeds_m_s: FloatArray
    roll_rad: FloatArray = field(default_factory=_level)
    pitch_rad: FloatArray = field(default_factory=_level)
    accelerations_m_s2: FloatArray | None = None
    time_s: FloatArray | None = None
    terrain: AnyArray | None = None
    heading_rad: FloatArray | None = None
    wheel_angles_rad: FloatArray | None = None
    yaw_rate_rad_s: FloatArray | None = None
    run_number: IntArray | None = None
    position_m: FloatArray | None = None
    unrepeated_m_s: FloatArray | None = None

    def __post_init__(self) -> None:
        speeds = np.asarray(self.tread_speeds_m_s)
        stack = np.broadcast_shapes(
            speeds.shape[:-1], np.shape(self.roll_rad), np.shape(self.pitch_rad)
        )
        object.__setattr__(self, "tread_speeds_m_s", np.broadcast_to(speeds, (*stack, 2)))
        object.__setattr__(self, "roll_rad", np.broadcast_to(self.roll_rad, stack))
        object.__setattr__(self, "pitch_rad", np.broadcast_to(self.pitch_rad, stack))

    @cached_property
    def tilt(self) -> Tilt | None:
        """Of every sample; None on level terrain."""
        if not (np.any(self.roll_rad) or np.any(self.pitch_rad)):
            return None
        return tilt_of(self.roll_rad, self.pitch_rad)

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
        named: dict[str, Any] = {
            name: None if values is None else values[chosen]
            for name, values in _given(self).items()
        }
        return Inputs(**named)


def joined(parts: Sequence[Inputs]) -> Inputs:
    """Stacks (N, ...) end to end; what one of them lacks, the whole lacks."""
    stacks = {name: [_given(part)[name] for part in parts] for name in _given(parts[0])}
    named: dict[str, Any] = {}
    for name, stack in stacks.items():
        known = [values for values in stack if values is not None]
        named[name] = np.concatenate(known) if len(known) == len(stack) else None
    return Inputs(**named)


def _given(inputs: Inputs) -> dict[str, AnyArray | None]:
    return {one.name: getattr(inputs, one.name) for one in fields(inputs)}
