"""What is known of a run at any moment: measured poses, and the travel of its treads."""

from dataclasses import dataclass

import numpy as np

from odometry.arrays import FloatArray
from odometry.geometry import se2
from odometry.run import Run

YAW_FOUND = "yaw_from_positions_sigma"  # column of pose tables whose yaw is no measured one


def measured_poses(run: Run) -> tuple[FloatArray, FloatArray, FloatArray]:
    """Stamps (M,), poses (M, 3) and source windows (M,), without rows of missing cells.

    Poses are those of the robot: where `[sensors]` states a lever arm, the measured position less
    R(yaw) times it.
    """
    if run.pose is None:
        return np.empty(0), np.empty((0, 3)), np.empty(0)
    poses = run.pose.stack("x", "y", "yaw")
    measured = np.isfinite(poses).all(axis=1)
    windows = run.pose["window"] if "window" in run.pose.columns else np.zeros(len(poses))
    return (
        run.pose.stamps_s[measured],
        of_robot(run, poses[measured]),
        np.nan_to_num(windows)[measured],
    )


def of_robot(run: Run, poses: FloatArray) -> FloatArray:
    """Poses (M, 3) of the robot's origin from those of the antenna that `[sensors]` places."""
    if run.sensors.pose_m is None:
        return poses
    arm_m = np.array(run.sensors.pose_m[:2])
    return np.column_stack([se2.transform(poses, -arm_m), poses[:, 2]])


def measured_positions(run: Run) -> tuple[FloatArray, FloatArray, FloatArray]:
    """Stamps (M,), positions (M, 2) and source windows (M,) of rows with x and y, yaw or not.

    Positions are those of the antenna, as recorded.
    """
    if run.pose is None:
        return np.empty(0), np.empty((0, 2)), np.empty(0)
    positions = run.pose.stack("x", "y")
    measured = np.isfinite(positions).all(axis=1)
    windows = run.pose["window"] if "window" in run.pose.columns else np.zeros(len(positions))
    return run.pose.stamps_s[measured], positions[measured], np.nan_to_num(windows)[measured]


def lacks_yaw(run: Run) -> bool:
    """Whether positions are measured and fewer than half of them with a yaw: GNSS, for example.

    A yaw that was found from positions is not measured.
    """
    if run.pose is not None and YAW_FOUND in run.pose:
        return True
    positions = len(measured_positions(run)[0])
    return 2 * len(measured_poses(run)[0]) < positions


@dataclass(frozen=True)
class TreadTravel:
    """Integrals over the tread speeds of a run, up to each of N stamps.

    Attributes
    ----------
    stamps_s : (N,)
    integrals_m : (N, 4)
        Of the speed (v_left + v_right) / 2, of the difference v_right - v_left, of the size of
        this difference, and of |v_left| + |v_right|.
    """

    stamps_s: FloatArray
    integrals_m: FloatArray

    def between(self, begin_s: FloatArray, end_s: FloatArray) -> FloatArray:
        """Integrals (4, K) from stamps (K,) to others; treads stand outside of the N stamps."""
        return np.stack(
            [
                np.interp(end_s, self.stamps_s, column) - np.interp(begin_s, self.stamps_s, column)
                for column in self.integrals_m.T
            ]
        )


def tread_travel(run: Run) -> TreadTravel:
    """Integrate the tread speeds of a run."""
    left, right = run.odometry.stack("v_left", "v_right").T
    rates = np.column_stack(
        [(left + right) / 2, right - left, np.abs(right - left), np.abs(left) + np.abs(right)]
    )
    stamps_s = run.odometry.stamps_s
    steps_m = rates[:-1] * np.diff(stamps_s)[:, None]
    return TreadTravel(stamps_s, np.concatenate([np.zeros((1, 4)), np.cumsum(steps_m, axis=0)]))
