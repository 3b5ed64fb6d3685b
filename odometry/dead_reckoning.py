"""From body twists to a trajectory, in the plane and in space."""

from collections.abc import Callable

import numpy as np

from odometry.arrays import FloatArray
from odometry.blocks import blocks_of, running_sums
from odometry.geometry import se2, se3
from odometry.geometry.angles import wrap
from odometry.geometry.tilt import level_steps, rises, tilt_of
from odometry.tables.table import level_where_missing
from odometry.trajectory import SpatialTrajectory, Trajectory


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

    Examples
    --------
    >>> import numpy as np
    >>> import odometry
    >>> stamps_s = np.array([0.0, 1.0])
    >>> twists = np.array([[0.0, 0.0, np.pi / 2], [0.0, 0.0, 0.0]])  # a quarter turn on the spot
    >>> odometry.dead_reckon(stamps_s, twists, np.zeros(3)).poses[-1].round(3).tolist()
    [0.0, 0.0, 1.571]
    """

    def steps(rows: slice) -> FloatArray:
        return _steps(stamps_s[rows.start : rows.stop + 1], twists[rows.start : rows.stop + 1])

    return Trajectory(np.asarray(stamps_s), _chain(steps, len(stamps_s), np.asarray(start)))


def dead_reckon_in_space(
    stamps_s: FloatArray,
    twists: FloatArray,
    roll_rad: FloatArray | None,
    pitch_rad: FloatArray | None,
    start: FloatArray,
) -> SpatialTrajectory:
    """Integrate twists over terrain whose tilt is measured (Martinez 2024 eq. 12).

    The attitude is REP-103's; eq. 12 is printed for another order of the angles (data/README.md).
    Each twist stays in the plane on which its step starts, so that on one tilted plane both
    position and heading are exact. The attitude of the answer is the measured roll and pitch.

    Parameters
    ----------
    stamps_s : (N,)
    twists : (N, 3)
        v_x [m/s], v_y [m/s], omega [rad/s] in the body frame; the last has no effect.
    roll_rad, pitch_rad : (N,) or None
        NaN where not measured: interpolated in time, held at the ends. Level where None or
        never measured; with both level this is `dead_reckon`.
    start : (4,)
        x, y, z [m] and yaw [rad] at the first stamp.

    Examples
    --------
    >>> import numpy as np
    >>> import odometry
    >>> stamps_s, twists = np.array([0.0, 1.0]), np.array([[1.0, 0.0, 0.0]] * 2)
    >>> pitch_rad = np.full(2, -0.1)  # nose up
    >>> path = odometry.dead_reckon_in_space(stamps_s, twists, None, pitch_rad, np.zeros(4))
    >>> print(path.poses[-1, :3, 3].round(3))  # x, y, z [m]
    [0.995 0.    0.1  ]
    """
    x, y, z, yaw = start
    roll, pitch = (level_where_missing(stamps_s, angle) for angle in (roll_rad, pitch_rad))
    steps, tilt = _steps(stamps_s, twists), tilt_of(roll[:-1], pitch[:-1])
    level = level_steps(steps, tilt)
    plane = _chain(lambda rows: level[rows].copy(), len(stamps_s), np.array([x, y, yaw]))
    heights = z + np.append(0.0, np.cumsum(rises(steps, tilt)))
    rotations = se3.rotation_from_roll_pitch_yaw(np.column_stack([roll, pitch, plane[:, 2]]))
    positions = np.column_stack([plane[:, :2], heights])
    return SpatialTrajectory(np.asarray(stamps_s), se3.pose(positions, rotations))


def _steps(stamps_s: FloatArray, twists: FloatArray) -> FloatArray:
    """Displacements (N - 1, 3) in the body frame at the start of each step."""
    return se2.exp(twists[:-1] * np.diff(stamps_s)[:, None])


def _chain(steps: Callable[[slice], FloatArray], count: int, start: FloatArray) -> FloatArray:
    """Poses (count, 3) reached by one step (k, 3) after another, see `running_sums`."""
    poses = np.empty((count, 3))
    for rows, turned in running_sums(lambda some: steps(some)[:, 2], count):
        poses[rows, 2] = start[2] + turned

    def moved(some: slice) -> FloatArray:
        step, yaw = steps(some), poses[some, 2]
        cosine, sine = np.cos(yaw), np.sin(yaw)
        return np.column_stack(
            [cosine * step[:, 0] - sine * step[:, 1], sine * step[:, 0] + cosine * step[:, 1]]
        )

    for rows, places in running_sums(moved, count):
        poses[rows, :2] = start[:2] + places
    for rows in blocks_of(count):
        poses[rows, 2] = wrap(poses[rows, 2])
    return poses
