"""A trajectory from elsewhere as the poses or the truth of a run folder."""

import numpy as np

from odometry.arrays import AnyArray
from odometry.errors import TrajectoryError
from odometry.spatial_trajectory import SpatialTrajectory
from odometry.table import Table


def pose_columns(trajectory: SpatialTrajectory) -> dict[str, AnyArray]:
    """Columns of pose.csv by name: t, x, y, yaw, z, roll, pitch."""
    x, y, z = trajectory.positions_m.T
    roll, pitch, yaw = trajectory.roll_pitch_yaw.T
    return {
        "t": trajectory.stamps_s,
        "x": x,
        "y": y,
        "yaw": yaw,
        "z": z,
        "roll": roll,
        "pitch": pitch,
    }


def poses_within(trajectory: SpatialTrajectory, odometry: Table) -> int:
    """How many poses lie within the odometry of a run.

    Raises
    ------
    TrajectoryError
        If none does: other clocks, or another run.
    """
    first_s, last_s = odometry.stamps_s[[0, -1]]
    within = int(np.sum((trajectory.stamps_s >= first_s) & (trajectory.stamps_s <= last_s)))
    if not within:
        raise TrajectoryError(
            f"the poses are of {trajectory.stamps_s[0]:.3f} to {trajectory.stamps_s[-1]:.3f} s, "
            f"{odometry.file} of {first_s:.3f} to {last_s:.3f} s; expected stamps of one clock"
        )
    return within


def doubt_of_axes(trajectory: SpatialTrajectory) -> str:
    """Why a trajectory seems not to have robot axes; empty where it seems to.

    A skid-steer robot moves most along x of its body.
    """
    moved = np.diff(trajectory.positions_m, axis=0)
    body = np.einsum("nji,nj->ni", trajectory.poses[:-1, :3, :3], moved)
    squares = np.sum(body**2, axis=0)
    told = int(np.argmax(squares))
    if told == 0:  # so it is where nothing moves
        return ""
    return (
        f"the body moves most along its {'xyz'[told]} axis; expected x "
        "forward. Poses of a camera (z along the view, y down) need --axes optical"
    )
