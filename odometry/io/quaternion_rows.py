"""Positions and quaternions of trajectory files as poses."""

from pathlib import Path

import numpy as np

from odometry.arrays import FloatArray, IntArray
from odometry.errors import TrajectoryError
from odometry.geometry import se3

LENGTH_TOLERANCE = 0.01  # of a quaternion: files with three digits pass, mixed columns rarely do


def poses_of(
    positions_m: FloatArray, quaternions_wxyz: FloatArray, rows: IntArray, file: Path
) -> FloatArray:
    """Poses (N, 4, 4) of positions (N, 3) and quaternions (N, 4) that stand in rows (N,) of a file.

    Raises
    ------
    TrajectoryError
        Naming the row, if a quaternion is not of length 1.
    """
    lengths = np.linalg.norm(quaternions_wxyz, axis=1)
    off = np.flatnonzero(np.abs(lengths - 1) > LENGTH_TOLERANCE)
    if off.size:
        raise TrajectoryError(
            f"{file}: row {rows[off[0]]}: a quaternion of length {lengths[off[0]]:.6g}, expected 1"
        )
    return se3.pose(positions_m, se3.rotation_from_quaternion_wxyz(quaternions_wxyz))
