"""Windows of equal wheel travel."""

import numpy as np

from odometry.arrays import FloatArray, IntArray


def spatial_horizons(travel_m: FloatArray, horizon_m: float, stride_m: float) -> IntArray:
    """Windows of a given wheel travel.

    Parameters
    ----------
    travel_m : (N,)
        Wheel travel at each sample, not decreasing.
    horizon_m : float
        Wheel travel of a window.
    stride_m : float
        Wheel travel from the start of one window to the start of the next.

    Returns
    -------
    (K, 2)
        First and last sample of each window. The last is the first sample at which the wheel
        travel is reached, so that a window may be longer than `horizon_m` by one step. While
        the robot is stationary, only one window starts.
    """
    travelled = travel_m - travel_m[0]
    last = np.floor(max(travelled[-1] - horizon_m, -1.0) / stride_m + 1e-9)
    strides = np.minimum(np.floor((travelled + 1e-9) / stride_m), last)  # whole ones up to a sample
    starts = np.flatnonzero(np.diff(strides, prepend=-1.0) > 0)
    ends = np.searchsorted(travelled, travelled[starts] + horizon_m - 1e-9)
    inside = ends < len(travel_m)
    return np.unique(np.stack([starts[inside], ends[inside]], axis=-1), axis=0)
