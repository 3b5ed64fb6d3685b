"""The yaw of a reference with whole turns counted, and where they cannot be."""

from typing import NamedTuple

import numpy as np

from odometry.arrays import FloatArray, IntArray
from odometry.recording.run import Run
from odometry.trajectory import Trajectory
from odometry.windows.recorded.turns import counted_turns


class CountedYaw(NamedTuple):
    """Yaw (N,) with whole turns counted, NaN where not measured, and parts (N,) by number.

    From one part to the next whole turns are not known.
    """

    yaw_rad: FloatArray
    part: IntArray


def counted_reference_yaw(run: Run, reference: Trajectory) -> CountedYaw:
    """Yaw of the reference with whole turns counted by the run, over its poses between as well."""
    yaw = reference.poses[:, 2]
    rows = np.flatnonzero(np.isfinite(yaw))
    counted = CountedYaw(np.full(len(yaw), np.nan), np.zeros(len(yaw), dtype=np.int64))
    if not len(rows):
        return counted
    stamps_s, yaws_rad = _with_poses_between(run, reference.stamps_s[rows], yaw[rows])
    turns = counted_turns(run, stamps_s, yaws_rad)
    at = np.searchsorted(stamps_s, reference.stamps_s[rows])
    counted.yaw_rad[rows] = turns.yaw_rad[at]
    counted.part[rows] = np.append(0, np.cumsum(~turns.known))[at]
    return counted


def _with_poses_between(
    run: Run, stamps_s: FloatArray, yaws_rad: FloatArray
) -> tuple[FloatArray, FloatArray]:
    """Stamps and yaws of poses of a run where all others are among them; else as they were."""
    if run.pose is None or "yaw" not in run.pose:
        return stamps_s, yaws_rad
    known = np.isfinite(run.pose["yaw"])
    of_poses_s, of_poses_rad = run.pose.stamps_s[known], run.pose["yaw"][known]
    if not np.isin(stamps_s, of_poses_s).all():
        return stamps_s, yaws_rad
    every = of_poses_rad.copy()
    every[np.searchsorted(of_poses_s, stamps_s)] = yaws_rad
    return of_poses_s, every
