"""Fitness of a dead-reckoned trajectory (Martinez 2024 eq. 13, Table II)."""

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from odometry.arrays import FloatArray
from odometry.errors import TrajectoryError
from odometry.geometry.angles import continuous_difference
from odometry.trajectory import SpatialTrajectory


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
        Whole turns of yaw count: an odometer that is two turns off errs more than one that is
        right.
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
