"""Measured poses of a run."""

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
