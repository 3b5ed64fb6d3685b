"""The optical frame of images, and the camera's own frame of a `mount`.

The optical frame (REP-103, OpenCV) has x right, y down and z along the view; the camera's own
frame has x along the view, y left and z up. Both have the same origin.
"""

import numpy as np

from odometry.arrays import FloatArray
from odometry.geometry import se3

# Columns: the camera's x, y and z axes in the optical frame
OPTICAL_FROM_CAMERA = np.array([[0.0, -1.0, 0.0], [0.0, 0.0, -1.0], [1.0, 0.0, 0.0]])


def mount_of_optical(
    robot_from_optical: FloatArray,
) -> tuple[float, float, float, float, float, float]:
    """The `mount` of a camera whose optical frame is known.

    Parameters
    ----------
    robot_from_optical : (4, 4)
        Pose of the optical frame in the robot frame: points of the one into points of the other.

    Returns
    -------
    x, y, z, roll, pitch, yaw
        Place [m] and attitude [rad] of the camera's own frame, R = Rz(yaw) Ry(pitch) Rx(roll).
    """
    transform = np.asarray(robot_from_optical, dtype=np.float64)
    angles = se3.roll_pitch_yaw(transform[:3, :3] @ OPTICAL_FROM_CAMERA)
    x, y, z, roll, pitch, yaw = map(float, (*transform[:3, 3], *angles))
    return x, y, z, roll, pitch, yaw


def optical_of_mount(mount: FloatArray) -> FloatArray:
    """Pose (4, 4) of the optical frame in the robot frame; the inverse of `mount_of_optical`."""
    mount = np.asarray(mount, dtype=np.float64)
    camera = se3.rotation_from_roll_pitch_yaw(mount[3:])
    return se3.pose(mount[:3], camera @ OPTICAL_FROM_CAMERA.T)
