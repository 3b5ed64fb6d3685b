"""Dead reckoning of a whole run from its first measured pose, and its fitness (Martinez 2024)."""

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from odometry.arrays import FloatArray
from odometry.dead_reckoning import dead_reckon_in_space
from odometry.errors import RunFolderError, TrajectoryError
from odometry.geometry.angles import continuous_difference
from odometry.recording.run import Run
from odometry.trajectory import SpatialTrajectory
from odometry.windows.recorded.run_inputs import attitude_of


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


@dataclass(frozen=True)
class Fitness:
    """Mean squared errors over N reference poses, the rows of Martinez 2024 Table II.

    Attributes
    ----------
    poses : int
        N, the reference poses that the trajectory covers.
    heights : int
        How many of them have a measured z.
    x_m2, y_m2, z_m2, yaw_rad2 : float
        Sums of squared errors, divided by N. A pose without a measured z adds nothing to z.
        Whole turns of yaw count: an odometer that is two turns off has a larger error
        than one that is right.
    """

    poses: int
    heights: int
    x_m2: float
    y_m2: float
    z_m2: float
    yaw_rad2: float

    @property
    def mean(self) -> float:
        """J / N: square metres and square radians added up, as eq. 13 does."""
        return self.x_m2 + self.y_m2 + self.z_m2 + self.yaw_rad2

    @property
    def total(self) -> float:
        """J of Martinez 2024 eq. 13; smaller is better."""
        return self.poses * self.mean


def pooled_fitness(of_runs: Sequence[Fitness]) -> float:
    """J / N over the poses of several runs."""
    return sum(each.total for each in of_runs) / sum(each.poses for each in of_runs)


def fitness(
    trajectory: SpatialTrajectory, reference_s: FloatArray, reference: FloatArray
) -> Fitness:
    """Compare a trajectory with measured poses.

    Parameters
    ----------
    trajectory : SpatialTrajectory
        As `open_loop` gives it: started at a reference pose, with poses at their stamps.
    reference_s : (M,)
        Stamps of the reference; those that the trajectory does not cover are left out.
    reference : (M, 4)
        x, y, z [m], yaw [rad] as `measured_poses` gives them; z may be NaN.

    Raises
    ------
    TrajectoryError
        If the trajectory covers none of the stamps.

    Examples
    --------
    >>> import numpy as np
    >>> import odometry
    >>> run = odometry.Run.read(odometry.shipped_data() / "runs" / "demo")
    >>> treads = odometry.inputs_of(run).tread_speeds_m_s
    >>> forward, turning = treads.mean(axis=1), np.diff(treads)[:, 0] / 0.4
    >>> twists = np.column_stack([forward, np.zeros(len(treads)), turning])  # ideal drive
    >>> path = odometry.open_loop(run, twists)
    >>> errors = odometry.fitness(path, *odometry.measured_poses(run))
    >>> f"J / N = {errors.mean:.1f}, of it yaw {errors.yaw_rad2:.1f}"
    'J / N = 22.4, of it yaw 0.2'
    """
    covered = trajectory.covers(reference_s)
    if not covered.any():
        raise TrajectoryError(
            f"the trajectory covers {trajectory.stamps_s[0]:.3f} to {trajectory.stamps_s[-1]:.3f} "
            f"s, which holds none of the {len(reference_s)} reference poses"
        )
    ours = trajectory.at(reference_s[covered])
    position_errors = ours.positions_m - reference[covered, :3]
    heading_errors = continuous_difference(ours.roll_pitch_yaw[:, 2], reference[covered, 3])
    has_height = np.isfinite(position_errors[:, 2])
    position_errors[~has_height, 2] = 0.0
    x, y, z = np.mean(position_errors**2, axis=0)
    return Fitness(
        poses=int(covered.sum()),
        heights=int(has_height.sum()),
        x_m2=float(x),
        y_m2=float(y),
        z_m2=float(z),
        yaw_rad2=float(np.mean(heading_errors**2)),
    )
