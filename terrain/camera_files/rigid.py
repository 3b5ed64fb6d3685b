"""Rigid transforms as files hold them: 4 x 4 matrices, often rounded."""

import numpy as np

from odometry.arrays import FloatArray
from odometry.geometry import se3
from terrain.errors import CameraError

ROUNDED = 0.005  # of the entries of a rotation: files write three digits


def rigid(transform: FloatArray, name: str) -> FloatArray:
    """The rigid transform (4, 4) nearest to a matrix that was rounded.

    Raises
    ------
    CameraError
        Naming it, if it is no rotation with a translation.
    """
    rotation = transform[:3, :3]
    if not np.isfinite(transform).all() or (transform[3] != [0, 0, 0, 1]).any():
        raise CameraError(f"{name} is no transform: its last row must be 0 0 0 1")
    u, _, v = np.linalg.svd(rotation)
    nearest = np.asarray(u @ v)
    if np.linalg.det(nearest) < 0 or np.abs(nearest - rotation).max() > ROUNDED:
        raise CameraError(f"{name} is no transform: its 3 x 3 part is no rotation")
    return se3.pose(transform[:3, 3], nearest)
