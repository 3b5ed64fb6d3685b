"""Angles on the circle, in radians."""

import numpy as np

from odometry.arrays import FloatArray


def wrap(angle: FloatArray | float) -> FloatArray:
    """The same angle in (-pi, pi]."""
    wrapped = np.pi - np.mod(np.pi - np.asarray(angle, dtype=np.float64), 2 * np.pi)
    return np.where(wrapped == -np.pi, np.pi, wrapped)  # the remainder may round up to 2 pi
