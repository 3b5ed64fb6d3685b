"""From body twists to a trajectory."""

import numpy as np

from odometry.arrays import FloatArray
from odometry.geometry import se2
from odometry.geometry.angles import wrap
from odometry.trajectory import Trajectory


def dead_reckon(stamps_s: FloatArray, twists: FloatArray, start: FloatArray) -> Trajectory:
    """Integrate twists in the plane, each constant until the next stamp.

    Parameters
    ----------
    stamps_s : (N,)
    twists : (N, 3)
        v_x [m/s], v_y [m/s], omega [rad/s] in the body frame; the last has no effect.
    start : (3,)
        Pose at the first stamp.

    Returns
    -------
    Trajectory
        N poses. Each step is the exact arc, so that splitting a step changes nothing.
    """
    steps = se2.exp(twists[:-1] * np.diff(stamps_s)[:, None])
    yaw = start[2] + np.concatenate([[0.0], np.cumsum(steps[:, 2])])
    cosine, sine = np.cos(yaw[:-1]), np.sin(yaw[:-1])
    x = np.cumsum(cosine * steps[:, 0] - sine * steps[:, 1])
    y = np.cumsum(sine * steps[:, 0] + cosine * steps[:, 1])
    poses = np.stack(
        [start[0] + np.append(0.0, x), start[1] + np.append(0.0, y), wrap(yaw)], axis=-1
    )
    return Trajectory(np.asarray(stamps_s), poses)
