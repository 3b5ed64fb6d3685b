"""Angles on the circle, in radians."""

import math

import numpy as np

from odometry.arrays import FloatArray


def wrap(angle: FloatArray | float) -> FloatArray:
    """The same angle in (-pi, pi]."""
    wrapped = np.pi - np.mod(np.pi - np.asarray(angle, dtype=np.float64), 2 * np.pi)
    return np.where(wrapped == -np.pi, np.pi, wrapped)  # the remainder may round up to 2 pi


def entries(angles: tuple[int, ...]) -> slice | tuple[int, ...]:
    """What picks these entries of vectors; a slice, which is faster, where they are in a row."""
    row = range(angles[0], angles[-1] + 1) if angles else range(0)
    return slice(row.start, row.stop) if angles == tuple(row) else angles


def wrap_one(angle: float) -> float:
    """`wrap` of one finite number, without an array."""
    if -math.pi < angle <= math.pi:
        return angle
    wrapped = angle - 2 * math.pi * math.ceil((angle - math.pi) / (2 * math.pi))
    return wrapped if wrapped > -math.pi else math.pi  # the quotient may round up


def continuous_difference(yaw: FloatArray, reference_yaw: FloatArray) -> FloatArray:
    """Differences (N,) of a yaw (N,) from a reference (N,), whole turns counted.

    The first is taken along the shorter way. From one sample to the next the difference is taken
    to change by less than half a turn, however far both turn.
    """
    return np.asarray(np.unwrap(wrap(np.asarray(yaw) - np.asarray(reference_yaw))))


def sine_and_cosine(angle: FloatArray) -> tuple[FloatArray, FloatArray]:
    """Both of angles (...), right to some 1e-16, from the tangent of half the angle.

    NumPy's tangent uses the processor's vector unit where its sine and cosine do not (version 2.4,
    x86-64): for stacks of thousands this takes a fifth of the time.
    """
    tangent = np.tan(angle / 2)
    square = tangent * tangent
    share = 1 / (1 + square)
    return 2 * tangent * share, (1 - square) * share
