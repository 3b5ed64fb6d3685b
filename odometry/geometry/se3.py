"""Rigid motions in space; a pose is a homogeneous matrix (4, 4), so that `@` composes two.

Roll, pitch and yaw are REP-103's: R = Rz(yaw) Ry(pitch) Rx(roll), in radians. Stacks broadcast.
"""

import numpy as np

from odometry.arrays import FloatArray

# Columns: the camera's x, y and z axes in the optical frame
OPTICAL_FROM_CAMERA = np.array([[0.0, -1.0, 0.0], [0.0, 0.0, -1.0], [1.0, 0.0, 0.0]])


def pose(position: FloatArray, rotation: FloatArray) -> FloatArray:
    """Pose (..., 4, 4) of a position (..., 3) in metres and a rotation matrix (..., 3, 3)."""
    position, rotation = np.asarray(position), np.asarray(rotation)
    made = np.zeros((*np.broadcast_shapes(position.shape[:-1], rotation.shape[:-2]), 4, 4))
    made[..., :3, :3] = rotation
    made[..., :3, 3] = position
    made[..., 3, 3] = 1.0
    return made


def inverse(poses: FloatArray) -> FloatArray:
    """The parent's pose in the frame of each pose (..., 4, 4)."""
    back = np.swapaxes(poses[..., :3, :3], -1, -2)
    return pose(-(back @ poses[..., :3, 3, None])[..., 0], back)


def between(first: FloatArray, second: FloatArray) -> FloatArray:
    """The pose of `second` in the frame of `first`, both given in one parent frame."""
    return np.asarray(inverse(first) @ second)


def rotation_from_roll_pitch_yaw(angles: FloatArray) -> FloatArray:
    """Rotation matrix (..., 3, 3) of roll, pitch, yaw (..., 3)."""
    (sr, sp, sy), (cr, cp, cy) = (
        np.moveaxis(function(angles), -1, 0) for function in (np.sin, np.cos)
    )
    rows = [
        np.stack([cy * cp, cy * sp * sr - sy * cr, cy * sp * cr + sy * sr], axis=-1),
        np.stack([sy * cp, sy * sp * sr + cy * cr, sy * sp * cr - cy * sr], axis=-1),
        np.stack([-sp, cp * sr, cp * cr], axis=-1),
    ]
    return np.stack(rows, axis=-2)


def roll_pitch_yaw(rotation: FloatArray) -> FloatArray:
    """Roll, pitch, yaw (..., 3) of rotation matrices (..., 3, 3), pitch in [-pi/2, pi/2].

    With the nose straight up or down only the difference or sum of roll and yaw is defined;
    the three angles still give the matrix back.
    """
    yaw = np.arctan2(rotation[..., 1, 0], rotation[..., 0, 0])
    sine, cosine = np.sin(yaw), np.cos(yaw)
    ahead = cosine * rotation[..., 0, 0] + sine * rotation[..., 1, 0]
    left = cosine[..., None] * rotation[..., 1, 1:] - sine[..., None] * rotation[..., 0, 1:]
    pitch = np.arctan2(-rotation[..., 2, 0], ahead)
    return np.stack([np.arctan2(-left[..., 1], left[..., 0]), pitch, yaw], axis=-1)


def rotation_from_quaternion_wxyz(quaternion: FloatArray) -> FloatArray:
    """Rotation matrix (..., 3, 3) of quaternions (..., 4) of any length but zero."""
    quaternion = np.asarray(quaternion, dtype=np.float64)
    w, x, y, z = np.moveaxis(quaternion / np.linalg.norm(quaternion, axis=-1, keepdims=True), -1, 0)
    rows = [
        np.stack([1 - 2 * (y**2 + z**2), 2 * (x * y - w * z), 2 * (x * z + w * y)], axis=-1),
        np.stack([2 * (x * y + w * z), 1 - 2 * (x**2 + z**2), 2 * (y * z - w * x)], axis=-1),
        np.stack([2 * (x * z - w * y), 2 * (y * z + w * x), 1 - 2 * (x**2 + y**2)], axis=-1),
    ]
    return np.stack(rows, axis=-2)


def quaternion_wxyz(rotation: FloatArray) -> FloatArray:
    """Unit quaternions (..., 4), w first and not negative, of matrices (..., 3, 3)."""
    rotation = np.asarray(rotation)
    diagonal = np.diagonal(rotation, axis1=-2, axis2=-1)
    trace = diagonal.sum(axis=-1)
    outer = np.empty((*trace.shape, 4, 4))  # 4 q q^T: each row is the quaternion times 4 q_i
    outer[..., 0, 0] = 1 + trace
    outer[..., 0, 1:] = outer[..., 1:, 0] = _skew_part(rotation)
    outer[..., 1:, 1:] = rotation + np.swapaxes(rotation, -1, -2)
    for axis in range(3):
        outer[..., axis + 1, axis + 1] = 1 - trace + 2 * diagonal[..., axis]
    best = np.argmax(np.diagonal(outer, axis1=-2, axis2=-1), axis=-1)
    row = np.take_along_axis(outer, best[..., None, None], axis=-2)[..., 0, :]
    row = np.where(row[..., :1] < 0, -row, row)
    return np.asarray(row / np.linalg.norm(row, axis=-1, keepdims=True))


def _skew_part(rotation: FloatArray) -> FloatArray:
    """Twice the sine of the angle times the axis (..., 3)."""
    return np.stack(
        [
            rotation[..., 2, 1] - rotation[..., 1, 2],
            rotation[..., 0, 2] - rotation[..., 2, 0],
            rotation[..., 1, 0] - rotation[..., 0, 1],
        ],
        axis=-1,
    )


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
    angles = roll_pitch_yaw(transform[:3, :3] @ OPTICAL_FROM_CAMERA)
    x, y, z, roll, pitch, yaw = map(float, (*transform[:3, 3], *angles))
    return x, y, z, roll, pitch, yaw


def optical_of_mount(mount: FloatArray) -> FloatArray:
    """Pose (4, 4) of the optical frame in the robot frame; the inverse of `mount_of_optical`."""
    mount = np.asarray(mount, dtype=np.float64)
    camera = rotation_from_roll_pitch_yaw(mount[3:])
    return pose(mount[:3], camera @ OPTICAL_FROM_CAMERA.T)
