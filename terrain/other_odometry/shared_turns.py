"""How two trajectories turn in the time that both cover."""

import numpy as np

from odometry.arrays import FloatArray
from odometry.evaluation.other_odometry import held_stamps
from odometry.trajectory import Trajectory

CONSTANT_RAD = 1e-3  # the limit of `yaw_constant` in the check of pose.csv
TURNED_RAD = 0.5  # a drive that turns by less says nothing about headings
WIDTH_S = 1.0  # over which turns are taken: above the noise of a gyroscope and of poses


def shared_pieces(trajectory: Trajectory, odometer: Trajectory) -> FloatArray:
    """First and last stamps (2, K) of pieces of WIDTH_S or two poses, in no gap of either."""
    begin_s = max(each.stamps_s[0] for each in (trajectory, odometer))
    end_s = min(each.stamps_s[-1] for each in (trajectory, odometer))
    width_s = max(WIDTH_S, 2 * float(np.median(np.diff(trajectory.stamps_s))))
    edges = np.arange(begin_s, end_s, width_s)
    held = held_stamps(trajectory, edges) & held_stamps(odometer, edges)
    both = held[:-1] & held[1:]
    return np.stack([edges[:-1][both], edges[1:][both]])


def turns_of(trajectory: Trajectory, yaw: FloatArray, ends_s: FloatArray) -> FloatArray:
    """Turn (K,) of each piece by a yaw (N,) at the stamps of a trajectory."""
    first, last = np.interp(ends_s, trajectory.stamps_s, np.unwrap(yaw))
    return np.asarray(last - first)
