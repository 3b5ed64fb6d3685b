"""Where a camera sees points of the terrain after the robot has moved."""

import numpy as np

from odometry.arrays import FloatArray
from odometry.geometry import se3
from odometry.geometry.optical_frame import OPTICAL_FROM_CAMERA

LEAST_SLOPE, LEAST_DEPTH_M = 1e-3, 1e-3


def carried_rays(
    rays: FloatArray, values: FloatArray, place_m: FloatArray, steps: FloatArray
) -> FloatArray:
    """Normalised image coordinates (N, 2) after the steps of points of the terrain seen at `rays`.

    Parameters
    ----------
    rays : (N, 2)
        Normalised, without distortion, before the steps.
    values : (4,)
        z [m], roll, pitch, yaw [rad] of the mount.
    place_m : (2,)
        x and y of the mount.
    steps : (N, 3) or (3,)
        Motion of the robot: x, y [m], yaw [rad].

    Returns
    -------
    (N, 2)
        NaN for rays that do not meet the terrain, or are then behind the camera.
    """
    robot_from_optical = se3.rotation_from_roll_pitch_yaw(values[1:]) @ OPTICAL_FROM_CAMERA.T
    directions = rays @ robot_from_optical[:, :2].T + robot_from_optical[:, 2]
    down = np.where(directions[:, 2] < -LEAST_SLOPE, -directions[:, 2], np.nan)
    ground_m = place_m + directions[:, :2] * (values[0] / down)[:, None]
    moved = ground_m - steps[..., :2]
    sine, cosine = np.sin(steps[..., 2]), np.cos(steps[..., 2])
    x = cosine * moved[:, 0] + sine * moved[:, 1] - place_m[0]
    y = -sine * moved[:, 0] + cosine * moved[:, 1] - place_m[1]
    seen = np.column_stack([x, y, np.full(len(x), -values[0])]) @ robot_from_optical
    depth = np.where(seen[:, 2] > LEAST_DEPTH_M, seen[:, 2], np.nan)
    return np.asarray(seen[:, :2] / depth[:, None])
