"""Vectors in the contact plane as complex numbers: real part forward, imaginary part left."""

from typing import Any

import numpy as np
from numpy.typing import NDArray

from odometry.arrays import FloatArray

ComplexArray = NDArray[np.complex128]
GRAVITY_M_S2 = 9.80665


def dot(first: Any, second: Any) -> FloatArray:
    """Scalar product of plane vectors, elementwise."""
    return np.asarray((np.conj(first) * second).real)


def cross(first: Any, second: Any) -> FloatArray:
    """Vertical component of the vector product of plane vectors, elementwise."""
    return np.asarray((np.conj(first) * second).imag)
