"""Dead reckoning of a whole run from its first measured pose, without any correction."""

import numpy as np

from odometry.arrays import FloatArray
from odometry.dead_reckoning import dead_reckon_in_space
from odometry.errors import RunFolderError, TrajectoryError
from odometry.run import Run
from odometry.run_inputs import attitude_of
from odometry.trajectory import SpatialTrajectory


def measured_poses(run: Run) -> tuple[FloatArray, FloatArray]:
    """Stamps (M,) and x, y, z, yaw (M, 4) of pose.csv; z is NaN where it was not measured.

    Raises
    ------
    RunFolderError
        If the run has no pose.csv, or no row of it has x, y and yaw.

    Examples
    --------
    >>> import odometry
    >>> run = odometry.Run.read(odometry.shipped_data() / "runs" / "demo")
    >>> stamps_s, poses = odometry.measured_poses(run)
    >>> poses.shape == (len(stamps_s), 4)
    True
    """
    if run.pose is None:
        raise RunFolderError(f"{run.folder / 'pose.csv'}: missing; a reference is needed")
    z = run.pose["z"] if "z" in run.pose else np.full(len(run.pose), np.nan)
    x, y, yaw = run.pose.stack("x", "y", "yaw").T
    poses = np.column_stack([x, y, z, yaw])
    measured = np.isfinite(poses[:, [0, 1, 3]]).all(axis=1)
    if not measured.any():
        raise RunFolderError(f"{run.pose.file}: no row has x, y and yaw; a reference is needed")
    return run.pose.stamps_s[measured], poses[measured]


def open_loop(run: Run, twists: FloatArray) -> SpatialTrajectory:
    """Integrate the twists of a model over a run.

    Starts at the first reference pose within odometry.csv; where pose.csv measures z, at the
    first that has one. Without any z, heights start at zero.

    Parameters
    ----------
    run : Run
        With pose.csv.
    twists : (N, 3)
        v_x, v_y [m/s], omega [rad/s] at each row of odometry.csv, in force until the next.

    Returns
    -------
    SpatialTrajectory
        Poses at the stamps of both odometry.csv and pose.csv up to the last row of odometry.

    Raises
    ------
    TrajectoryError
        If no such reference pose lies within odometry.csv.

    Examples
    --------
    >>> import numpy as np
    >>> import odometry
    >>> run = odometry.Run.read(odometry.shipped_data() / "runs" / "demo")
    >>> twists = np.tile([0.5, 0.0, 0.0], (len(run.odometry), 1))
    >>> path = odometry.open_loop(run, twists)
    >>> f"{path.poses[-1, 0, 3]:.1f} m straight ahead in {path.stamps_s[-1]:.0f} s"
    '27.1 m straight ahead in 54 s'
    """
    odometry_s = run.odometry.stamps_s
    reference_s, poses = measured_poses(run)
    has_height = np.isfinite(poses[:, 2])
    within = (reference_s >= odometry_s[0]) & (reference_s <= odometry_s[-1])
    starts = np.flatnonzero(within & (has_height | ~has_height.any()))
    if not len(starts):
        raise TrajectoryError(
            f"{run.folder}: pose.csv covers {reference_s[0]:.3f} to {reference_s[-1]:.3f} s, "
            f"odometry.csv {odometry_s[0]:.3f} to {odometry_s[-1]:.3f} s; expected a measured "
            "pose within odometry.csv"
        )
    start_s, start = reference_s[starts[0]], np.nan_to_num(poses[starts[0]])
    stamps_s = np.union1d(odometry_s, reference_s)
    stamps_s = stamps_s[(stamps_s >= start_s) & (stamps_s <= odometry_s[-1])]
    rows = np.searchsorted(odometry_s, stamps_s, side="right") - 1
    roll, pitch = (np.interp(stamps_s, odometry_s, angle) for angle in attitude_of(run))
    return dead_reckon_in_space(stamps_s, twists[rows], roll, pitch, start)
