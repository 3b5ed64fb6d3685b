"""The motion of dense windows from a path over the samples of a run."""

import numpy as np

from odometry.arrays import FloatArray
from odometry.windows.dense import DenseWindows, motion_from_first


def poses_at(path: FloatArray, windows: DenseWindows, seen_s: FloatArray) -> FloatArray:
    """Poses (M, 3) of a path (N, 3) over a run's samples at run times (M,)."""
    return np.stack([np.interp(seen_s, windows.time_s, column) for column in path.T], axis=-1)


def off_measured(poses: FloatArray, windows: DenseWindows) -> FloatArray:
    """Measured motion less that of poses (M, 3), (K, n, 3), in the frame of each first pose.

    Yaw of the poses must not be wrapped: turns are compared with all whole turns in them.
    """
    return np.asarray(windows.measured - motion_from_first(poses[windows.windows]))
