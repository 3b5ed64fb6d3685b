"""Measured poses of a run, and measured positions."""

import numpy as np

from odometry.arrays import FloatArray
from odometry.run import Run


def measured_poses(run: Run) -> tuple[FloatArray, FloatArray, FloatArray]:
    """Stamps (M,), poses (M, 3) and source windows (M,), without rows of missing cells."""
    if run.pose is None:
        return np.empty(0), np.empty((0, 3)), np.empty(0)
    poses = run.pose.stack("x", "y", "yaw")
    measured = np.isfinite(poses).all(axis=1)
    windows = run.pose["window"] if "window" in run.pose.columns else np.zeros(len(poses))
    return run.pose.stamps_s[measured], poses[measured], np.nan_to_num(windows)[measured]


def measured_positions(run: Run) -> tuple[FloatArray, FloatArray, FloatArray]:
    """Stamps (M,), positions (M, 2) and source windows (M,) of rows with x and y, yaw or not."""
    if run.pose is None:
        return np.empty(0), np.empty((0, 2)), np.empty(0)
    positions = run.pose.stack("x", "y")
    measured = np.isfinite(positions).all(axis=1)
    windows = run.pose["window"] if "window" in run.pose.columns else np.zeros(len(positions))
    return run.pose.stamps_s[measured], positions[measured], np.nan_to_num(windows)[measured]


def lacks_yaw(run: Run) -> bool:
    """Whether positions are measured and fewer than half of them with a yaw: GNSS, for example."""
    positions = len(measured_positions(run)[0])
    return 2 * len(measured_poses(run)[0]) < positions
