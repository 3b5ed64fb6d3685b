"""A trajectory: stamped poses in the plane."""

from dataclasses import dataclass

import numpy as np

from odometry.arrays import BoolArray, FloatArray
from odometry.errors import TrajectoryError
from odometry.geometry import se2
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

    def at(self, stamps_s: FloatArray) -> "Trajectory":
        """Poses at other stamps, linear in x, y and along the shorter way in yaw.

        Raises
        ------
        TrajectoryError
            If a stamp lies outside of this trajectory.
        """
        stamps_s = require_within(self.stamps_s, stamps_s)
        continuous = self.poses.copy()
        continuous[:, 2] = np.unwrap(continuous[:, 2])
        poses = np.stack(
            [np.interp(stamps_s, self.stamps_s, column) for column in continuous.T], axis=-1
        )
        poses[:, 2] = wrap(poses[:, 2])
        return Trajectory(stamps_s, poses)

    def moved(self, pose: FloatArray) -> "Trajectory":
        """The same trajectory with its frame placed at `pose` (3,) of a parent frame."""
        return Trajectory(self.stamps_s, se2.compose(np.asarray(pose), self.poses))
