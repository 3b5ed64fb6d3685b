"""Rows of pose.csv and other_odometry from poses, transforms and satellite fixes."""

from collections.abc import Callable
from typing import Any

import numpy as np

from odometry.arrays import BoolArray, FloatArray, IntArray
from odometry.bags.message_kinds import POSES
from odometry.errors import BagError
from odometry.geometry import se3

Row = tuple[float, ...]
POSE_COLUMNS = ("x", "y", "yaw", "z", "roll", "pitch")


def pose_reader(message_type: str) -> Callable[[Any], Row]:
    """A function that takes x, y, z, qw, qx, qy, qz out of a message."""
    pose_of = POSES[message_type]

    def read(message: Any) -> Row:
        pose = pose_of(message)
        if hasattr(pose, "translation"):
            place, turn = pose.translation, pose.rotation
        else:
            place, turn = pose.position, pose.orientation
        return place.x, place.y, place.z, turn.w, turn.x, turn.y, turn.z

    return read


class AttitudesOf:
    """Turns poses of a frame into places of its origin and attitudes of the robot.

    The place stays that of the frame's origin: its place on the robot goes to [sensors] pose.
    """

    def __init__(self, robot_from_body: FloatArray) -> None:
        self._body_from_robot = robot_from_body[:3, :3].T

    def __call__(self, stamps_ns: IntArray, rows: FloatArray) -> tuple[IntArray, FloatArray]:
        """Columns (N, 6) as POSE_COLUMNS of rows (N, 7); no attitude where there is none."""
        rotations, told = rotations_of(rows[:, 3:])
        roll, pitch, yaw = se3.roll_pitch_yaw(rotations @ self._body_from_robot).T
        angles = np.where(told, np.stack([yaw, roll, pitch]) + 0.0, np.nan)  # -0 becomes 0
        x, y, z = np.where(np.isfinite(rows[:, :3]).all(axis=1), rows[:, :3].T, np.nan)
        return stamps_ns, np.column_stack([x, y, angles[0], z, angles[1], angles[2]])


class PosesOfRobot:
    """Turns poses of a frame into x, y, yaw of the robot's own origin."""

    def __init__(self, robot_from_body: FloatArray) -> None:
        self._body_from_robot = se3.inverse(robot_from_body)

    def __call__(self, stamps_ns: IntArray, rows: FloatArray) -> tuple[IntArray, FloatArray]:
        """Columns (N, 3) of rows (N, 7); NaN where there is no attitude."""
        rotations, told = rotations_of(rows[:, 3:])
        poses = se3.pose(rows[:, :3], rotations) @ self._body_from_robot
        yaw = se3.roll_pitch_yaw(poses[:, :3, :3])[:, 2]
        columns = np.column_stack([poses[:, 0, 3], poses[:, 1, 3], yaw])
        return stamps_ns, np.where(told[:, None], columns, np.nan)


def fix_row(message: Any) -> Row:
    """Latitude and longitude [degrees] and altitude [m] of a NavSatFix.

    Raises
    ------
    BagError
        If it says that there was no fix.
    """
    if message.status.status < 0 or not np.isfinite([message.latitude, message.longitude]).all():
        raise BagError("no fix")
    return message.latitude, message.longitude, message.altitude


def point_row(message: Any) -> Row:
    """x, y, z [m] of a PointStamped."""
    return message.point.x, message.point.y, message.point.z


def positions_alone(stamps_ns: IntArray, rows: FloatArray) -> tuple[IntArray, FloatArray]:
    """Columns (N, 4): x, y, yaw (NaN), z of positions (N, 3)."""
    return stamps_ns, np.insert(rows, 2, np.nan, axis=1)


class LocalMetres:
    """Turns geodetic places into metres east, north and up of the first one."""

    def __init__(self) -> None:
        self.origin: tuple[float, float, float] | None = None

    def __call__(self, stamps_ns: IntArray, rows: FloatArray) -> tuple[IntArray, FloatArray]:
        """Columns (N, 4): x (east), y (north), yaw (NaN), z (up)."""
        from pymap3d import geodetic2enu  # noqa: PLC0415 - only bags with fixes need it

        if not len(rows):
            return stamps_ns, np.empty((0, 4))
        if self.origin is None:
            latitude, longitude, altitude = rows[0].tolist()
            self.origin = latitude, longitude, altitude if np.isfinite(altitude) else 0.0
        altitudes = np.where(np.isfinite(rows[:, 2]), rows[:, 2], self.origin[2])
        east, north, up = geodetic2enu(rows[:, 0], rows[:, 1], altitudes, *self.origin)
        return stamps_ns, np.column_stack([east, north, np.full(len(rows), np.nan), up])


def rotations_of(quaternions_wxyz: FloatArray) -> tuple[FloatArray, BoolArray]:
    """Rotations (N, 3, 3), and whether each quaternion (N, 4) is one."""
    lengths = np.linalg.norm(quaternions_wxyz, axis=1)
    told = np.abs(lengths - 1) < 0.1
    unit = np.where(told[:, None], quaternions_wxyz, [1.0, 0.0, 0.0, 0.0])
    return se3.rotation_from_quaternion_wxyz(unit), told
