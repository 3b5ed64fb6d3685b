"""Measured columns with cells that are missing."""

import numpy as np

from odometry.arrays import FloatArray
from odometry.errors import TrajectoryError


def fill_gaps(stamps_s: FloatArray, values: FloatArray) -> FloatArray:
    """Values (N,) with NaN replaced: linear over gaps in time, held at both ends.

    Raises
    ------
    TrajectoryError
        If there is not one value a stamp, or none is a number.
    """
    values = np.asarray(values, dtype=np.float64)
    measured = np.isfinite(values)
    if values.shape != np.shape(stamps_s) or not measured.any():
        raise TrajectoryError(
            f"{measured.sum()} measured of {values.shape} values for {len(stamps_s)} stamps; "
            "expected one value a stamp, and one measured at least"
        )
    return np.interp(stamps_s, np.asarray(stamps_s)[measured], values[measured])


def level_where_missing(stamps_s: FloatArray, angle_rad: FloatArray | None) -> FloatArray:
    """Roll or pitch (N,) with its gaps filled; level terrain where it was never measured."""
    if angle_rad is None or np.all(np.isnan(angle_rad)):
        return np.zeros(len(stamps_s))
    return fill_gaps(stamps_s, angle_rad)
