"""Rows of pose.csv: poses and positions; roll and pitch of Imu messages."""

import math
import tempfile
from collections.abc import Callable
from itertools import islice
from pathlib import Path
from typing import Any

import numpy as np

from odometry.arrays import BoolArray, FloatArray, IntArray
from odometry.bags.files.topic import PLACE, Topic, moved
from odometry.bags.topics.message_fields import POSES
from odometry.bags.topics.transforms import plain_frame
from odometry.errors import BagError
from odometry.geometry import se3
from odometry.io.files import naming_temporary

TILTED_DEG = 50.0  # no skid-steer robot drives there in the mean
OFF_GRAVITY_DEG = 15.0  # of the mean specific force, from the vertical of the orientation
LEAST_GRAVITY_M_S2 = 5.0  # less: gravity is left out of the accelerations, or the unit is another
BLOCK = 8192  # rows of odometry.csv at a time


class Attitudes:
    """Keeps attitudes in a file without a name: memory does not grow with their number.

    Attributes
    ----------
    written : int
        Number of attitudes written.
    """

    def __init__(self, robot_from_imu: FloatArray) -> None:
        """`robot_from_imu` (3, 3) turns vectors of the sensor's axes into the robot's."""
        self.written = 0
        self._imu_from_robot = robot_from_imu.T
        self._robot_up, self._force = np.zeros(3), np.zeros(3)  # sums, in the world
        self._first: FloatArray | None = None
        self._turned = False
        self._file = tempfile.TemporaryFile()  # noqa: SIM115 - closed by close

    def close(self) -> None:
        """Give the attitudes up."""
        self._file.close()

    def add(self, stamps_ns: IntArray, orientations: FloatArray, forces_m_s2: FloatArray) -> None:
        """Take in quaternions (N, 4), w first, of the sensor in a world whose z is up.

        `forces_m_s2` (N, 3 or 0) are the accelerometer's, by which the vertical is checked.
        """
        rotations, valid = rotations_of(orientations)
        rotations = rotations[valid]
        if not len(rotations):
            return
        if self._first is None:
            self._first = orientations[valid][0]
        self._turned |= bool((orientations[valid] != self._first).any())
        of_robot = rotations @ self._imu_from_robot
        self._robot_up += of_robot[:, :, 2].sum(axis=0)
        if forces_m_s2.shape[1] == 3:
            self._force += np.einsum("nij,nj->i", rotations, np.nan_to_num(forces_m_s2[valid]))
        angles = se3.roll_pitch_yaw(of_robot)[:, :2]
        with naming_temporary():
            self._file.write(np.column_stack([stamps_ns[valid] / 1e9, angles]).tobytes())
        self.written += len(rotations)

    def doubt(self) -> str:
        """Why these are no roll and pitch of the robot; empty where nothing says so."""
        if not self._turned:
            return "it never changes: the driver does not fill it in"
        tilt = _from_vertical_deg(self._robot_up)
        if tilt > TILTED_DEG:
            return (
                f"by it the robot is tilted by {tilt:.0f} degrees in the mean: the attitude of the "
                "sensor on the robot is not known, or its world has z downwards"
            )
        off = _from_vertical_deg(self._force)
        with_gravity = np.linalg.norm(self._force) > LEAST_GRAVITY_M_S2 * self.written
        if with_gravity and off > OFF_GRAVITY_DEG:
            return f"its vertical is {off:.0f} degrees off the mean of the accelerations"
        return ""

    def into(self, odometry_csv: Path) -> None:
        """Add the columns roll and pitch [rad] to a file; empty before and after the attitudes."""
        with naming_temporary():
            self._file.flush()
        kept = np.memmap(self._file, dtype=float, mode="r").reshape(-1, 3)
        part = odometry_csv.with_suffix(".part")
        with odometry_csv.open(encoding="utf-8") as old, part.open("w", encoding="utf-8") as new:
            new.write(next(old).rstrip("\n") + ",roll,pitch\n")
            while lines := list(islice(old, BLOCK)):
                stamps_s = np.array([float(line[: line.index(",")]) for line in lines])
                begin, end = np.searchsorted(kept[:, 0], stamps_s[[0, -1]])
                near = np.array(kept[max(0, begin - 1) : end + 1])
                angles = [np.interp(stamps_s, near[:, 0], near[:, i], *_NONE) for i in (1, 2)]
                rows = zip(lines, *(each.tolist() for each in angles), strict=True)
                new.writelines(f"{line[:-1]},{_cell(r)},{_cell(p)}\n" for line, r, p in rows)
        part.replace(odometry_csv)


_NONE = (math.nan, math.nan)  # before the first, after the last


def _cell(angle_rad: float) -> str:
    return "" if math.isnan(angle_rad) else f"{angle_rad:.6g}"


def _from_vertical_deg(vector: FloatArray) -> float:
    return math.degrees(math.atan2(math.hypot(vector[0], vector[1]), vector[2]))


Row = tuple[float, ...]
POSE_COLUMNS = ("x", "y", "yaw", "z", "roll", "pitch")


def turns(topic: Topic) -> bool:
    """Whether poses have an orientation: one that never changes while they move is none."""
    moves = any(moved(topic.ranges, PLACE, axis) for axis in "xy")
    return not moves or any(moved(topic.ranges, PLACE, f"orientation.{a}") for a in "wxyz")


def pose_reader(topic: Topic) -> Callable[[Any], Row]:
    """A function that takes x, y, z, qw, qx, qy, qz out of a message.

    It raises BagError where a pose is in another frame than most.
    """
    pose_of = POSES[topic.message_type]
    world = topic.worlds[0] if topic.worlds else ""

    def read(message: Any) -> Row:
        found = plain_frame(message.header.frame_id)
        if found != world:
            raise BagError(f"a pose in the frame {found!r}, where most are in {world!r}")
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

    def __init__(self, robot_from_body: FloatArray, *, measured: bool = True) -> None:
        """Without `measured` attitudes are left out."""
        self._body_from_robot = robot_from_body[:3, :3].T
        self._measured = measured

    def __call__(self, stamps_ns: IntArray, rows: FloatArray) -> tuple[IntArray, FloatArray]:
        """Columns (N, 6) as POSE_COLUMNS of rows (N, 7); no attitude where there is none."""
        rotations, valid = rotations_of(rows[:, 3:])
        valid &= self._measured
        roll, pitch, yaw = se3.roll_pitch_yaw(rotations @ self._body_from_robot).T
        angles = np.where(valid, np.stack([yaw, roll, pitch]) + 0.0, np.nan)  # -0 becomes 0
        x, y, z = np.where(np.isfinite(rows[:, :3]).all(axis=1), rows[:, :3].T, np.nan)
        return stamps_ns, np.column_stack([x, y, angles[0], z, angles[1], angles[2]])


class PosesOfRobot:
    """Turns poses of a frame into x, y, yaw of the robot's own origin."""

    def __init__(self, robot_from_body: FloatArray) -> None:
        self._body_from_robot = se3.inverse(robot_from_body)

    def __call__(self, stamps_ns: IntArray, rows: FloatArray) -> tuple[IntArray, FloatArray]:
        """Columns (N, 3) of rows (N, 7); NaN where there is no attitude."""
        rotations, valid = rotations_of(rows[:, 3:])
        poses = se3.pose(rows[:, :3], rotations) @ self._body_from_robot
        yaw = se3.roll_pitch_yaw(poses[:, :3, :3])[:, 2]
        columns = np.column_stack([poses[:, 0, 3], poses[:, 1, 3], yaw])
        return stamps_ns, np.where(valid[:, None], columns, np.nan)


def point_row(message: Any) -> Row:
    """x, y, z [m] of a PointStamped."""
    return message.point.x, message.point.y, message.point.z


def positions_alone(stamps_ns: IntArray, rows: FloatArray) -> tuple[IntArray, FloatArray]:
    """Columns (N, 4): x, y, yaw (NaN), z of positions (N, 3)."""
    return stamps_ns, np.insert(rows, 2, np.nan, axis=1)


def rotations_of(quaternions_wxyz: FloatArray) -> tuple[FloatArray, BoolArray]:
    """Rotations (N, 3, 3), and whether each quaternion (N, 4) is one."""
    lengths = np.linalg.norm(quaternions_wxyz, axis=1)
    valid = np.abs(lengths - 1) < 0.1
    unit = np.where(valid[:, None], quaternions_wxyz, [1.0, 0.0, 0.0, 0.0])
    return se3.rotation_from_quaternion_wxyz(unit), valid
