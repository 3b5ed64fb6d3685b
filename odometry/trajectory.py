"""Trajectories: stamped poses in the plane, and in space with height and attitude."""

from dataclasses import dataclass

import numpy as np
from scipy.spatial.transform import Rotation

from odometry.arrays import BoolArray, FloatArray, IntArray
from odometry.errors import TrajectoryError
from odometry.geometry import se2, se3
from odometry.geometry.angles import wrap


def lies_within(stamps_s: FloatArray, asked_s: FloatArray) -> BoolArray:
    """Which of the requested stamps (M,) lie between the first and the last of stamps (N,)."""
    return np.asarray((asked_s >= stamps_s[0]) & (asked_s <= stamps_s[-1]))


def require_within(stamps_s: FloatArray, asked_s: FloatArray) -> FloatArray:
    """The requested stamps (M,) as floats; TrajectoryError if one lies outside of stamps (N,)."""
    asked_s = np.asarray(asked_s, dtype=np.float64)
    if len(asked_s) and not np.all(lies_within(stamps_s, asked_s)):
        raise TrajectoryError(
            f"asked for {asked_s.min():.3f} to {asked_s.max():.3f} s; the trajectory covers "
            f"{stamps_s[0]:.3f} to {stamps_s[-1]:.3f} s"
        )
    return asked_s


@dataclass(frozen=True)
class Trajectory:
    """Stamped poses of the robot in one fixed frame.

    Attributes
    ----------
    stamps_s : (N,)
        Strictly increasing.
    poses : (N, 3)
        x [m], y [m], yaw [rad].

    Examples
    --------
    >>> import numpy as np
    >>> import odometry
    >>> path = odometry.Trajectory(np.array([0.0, 1.0]), np.array([[0.0] * 3, [2.0, 0.0, 0.0]]))
    >>> path.at(np.array([0.25])).poses.tolist()
    [[0.5, 0.0, 0.0]]
    """

    stamps_s: FloatArray
    poses: FloatArray

    def __post_init__(self) -> None:
        if self.poses.shape != (len(self.stamps_s), 3):
            raise TrajectoryError(
                f"poses of shape {self.poses.shape} for {len(self.stamps_s)} stamps; expected "
                f"({len(self.stamps_s)}, 3)"
            )
        if np.any(np.diff(self.stamps_s) <= 0):
            raise TrajectoryError("the stamps of a trajectory must increase strictly")

    def __len__(self) -> int:
        return len(self.stamps_s)

    def covers(self, stamps_s: FloatArray) -> BoolArray:
        """Which stamps (M,) lie between the first and the last of this trajectory."""
        return lies_within(self.stamps_s, stamps_s)

    def rows(self, chosen: slice | IntArray) -> "Trajectory":
        """The same trajectory with only the chosen rows, in their order."""
        return Trajectory(self.stamps_s[chosen], self.poses[chosen])

    def at(self, stamps_s: FloatArray) -> "Trajectory":
        """Poses at other stamps, linear in x, y and along the shorter way in yaw.

        Raises
        ------
        TrajectoryError
            If a stamp lies outside of this trajectory.
        """
        stamps_s = require_within(self.stamps_s, stamps_s)
        columns = (*self.poses[:, :2].T, np.unwrap(self.poses[:, 2]))
        poses = np.stack([np.interp(stamps_s, self.stamps_s, each) for each in columns], axis=-1)
        poses[:, 2] = wrap(poses[:, 2])
        return Trajectory(stamps_s, poses)

    def moved(self, pose: FloatArray) -> "Trajectory":
        """The same trajectory with its frame placed at `pose` (3,) of a parent frame."""
        return Trajectory(self.stamps_s, se2.compose(np.asarray(pose), self.poses))


@dataclass(frozen=True)
class SpatialTrajectory:
    """Stamped poses of the robot in one fixed frame whose z points upwards.

    Attributes
    ----------
    stamps_s : (N,)
        Strictly increasing.
    poses : (N, 4, 4)
        Homogeneous matrices from the robot's frame to the fixed one, metres.

    Examples
    --------
    >>> import numpy as np
    >>> import odometry
    >>> path = odometry.SpatialTrajectory(np.array([0.0, 1.0]), np.stack([np.eye(4), np.eye(4)]))
    >>> len(path)
    2
    """

    stamps_s: FloatArray
    poses: FloatArray

    def __post_init__(self) -> None:
        if self.poses.shape != (len(self.stamps_s), 4, 4):
            raise TrajectoryError(
                f"poses of shape {self.poses.shape} for {len(self.stamps_s)} stamps; expected "
                f"({len(self.stamps_s)}, 4, 4)"
            )
        if np.any(np.diff(self.stamps_s) <= 0):
            raise TrajectoryError("the stamps of a trajectory must increase strictly")

    @classmethod
    def from_plane(cls, trajectory: Trajectory) -> "SpatialTrajectory":
        """A trajectory of the plane on level terrain at z = 0."""
        x, y, yaw = trajectory.poses.T
        zero = np.zeros_like(x)
        rotation = se3.rotation_from_roll_pitch_yaw(np.column_stack([zero, zero, yaw]))
        return cls(trajectory.stamps_s, se3.pose(np.column_stack([x, y, zero]), rotation))

    def __len__(self) -> int:
        return len(self.stamps_s)

    @property
    def positions_m(self) -> FloatArray:
        """x, y, z (N, 3)."""
        return self.poses[:, :3, 3]

    @property
    def roll_pitch_yaw(self) -> FloatArray:
        """Roll, pitch, yaw (N, 3) in radians, REP-103."""
        return se3.roll_pitch_yaw(self.poses[:, :3, :3])

    @property
    def quaternions_wxyz(self) -> FloatArray:
        """Unit quaternions (N, 4), w not negative."""
        return se3.quaternion_wxyz(self.poses[:, :3, :3])

    @property
    def plane(self) -> Trajectory:
        """x, y and yaw alone."""
        yaw = self.roll_pitch_yaw[:, 2]
        return Trajectory(self.stamps_s, np.column_stack([self.positions_m[:, :2], yaw]))

    def covers(self, stamps_s: FloatArray) -> BoolArray:
        """Which stamps (M,) lie between the first and the last of this trajectory."""
        return lies_within(self.stamps_s, stamps_s)

    def at(self, stamps_s: FloatArray) -> "SpatialTrajectory":
        """Poses at other stamps: positions linear, attitude along the shortest turn.

        Raises
        ------
        TrajectoryError
            If a stamp lies outside of this trajectory.
        """
        stamps_s = require_within(self.stamps_s, stamps_s)
        before = np.searchsorted(self.stamps_s, stamps_s, side="right") - 1
        after = np.minimum(before + 1, len(self) - 1)
        duration_s = np.where(after > before, self.stamps_s[after] - self.stamps_s[before], 1.0)
        part = ((stamps_s - self.stamps_s[before]) / duration_s)[:, None]
        first, second = self.poses[before], self.poses[after]
        turn = Rotation.from_matrix(se3.between(first, second)[:, :3, :3]).as_rotvec()
        rotation = first[:, :3, :3] @ Rotation.from_rotvec(part * turn).as_matrix()
        position = (1 - part) * first[:, :3, 3] + part * second[:, :3, 3]
        return SpatialTrajectory(stamps_s, se3.pose(position, rotation))

    def moved(self, pose: FloatArray) -> "SpatialTrajectory":
        """The same trajectory with its frame placed at `pose` (4, 4) of a parent frame."""
        return SpatialTrajectory(self.stamps_s, np.asarray(pose @ self.poses))
