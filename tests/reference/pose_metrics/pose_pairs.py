"""Pairs of poses between which relative errors are taken: (K, 2) first and last sample."""

import numpy as np

from odometry.arrays import FloatArray, IntArray
from odometry.config import require
from odometry.trajectory import SpatialTrajectory


def consecutive_frame_pairs(trajectory: SpatialTrajectory, frames: int) -> IntArray:
    """Pairs that follow one another, each of a number of frames."""
    require(frames >= 1, f"frames = {frames}, expected 1 or more")
    ends = np.arange(0, len(trajectory), frames)
    return np.stack([ends[:-1], ends[1:]], axis=-1)


def all_frame_pairs(trajectory: SpatialTrajectory, frames: int) -> IntArray:
    """A pair of a number of frames from every pose."""
    require(frames >= 1, f"frames = {frames}, expected 1 or more")
    starts = np.arange(max(len(trajectory) - frames, 0))
    return np.stack([starts, starts + frames], axis=-1)


def consecutive_path_pairs(trajectory: SpatialTrajectory, path_m: float) -> IntArray:
    """Pairs that follow one another, each ending where its path has reached `path_m`."""
    require(path_m > 0, f"path_m = {path_m}, expected above 0")
    ends, path = [0], 0.0
    for end, step_m in enumerate(_step_lengths(trajectory), start=1):
        path += float(step_m)
        if path >= path_m:
            ends.append(end)
            path = 0.0
    return np.stack([ends[:-1], ends[1:]], axis=-1).astype(np.int64)


def all_path_pairs(
    trajectory: SpatialTrajectory, path_m: float, relative_tolerance: float = 0.1
) -> IntArray:
    """From every pose, the pair whose path is nearest to `path_m`, if it is near enough.

    Parameters
    ----------
    trajectory : SpatialTrajectory
    path_m : float
        Length of path between the two poses.
    relative_tolerance : float
        Pairs whose path differs from `path_m` by more than this part of it are left out.
    """
    require(path_m > 0, f"path_m = {path_m}, expected above 0")
    path = np.append(0.0, np.cumsum(_step_lengths(trajectory)))
    starts = np.arange(len(path) - 1)
    after = np.minimum(np.searchsorted(path, path[:-1] + path_m), len(path) - 1)
    before = np.maximum(np.searchsorted(path, path[after - 1]), starts + 1)  # first of equals
    miss_before, miss_after = (np.abs(path[end] - path[:-1] - path_m) for end in (before, after))
    ends = np.where(miss_before <= miss_after, before, after)
    near = np.minimum(miss_before, miss_after) <= relative_tolerance * path_m
    return np.stack([starts[near], ends[near]], axis=-1)


def _step_lengths(trajectory: SpatialTrajectory) -> FloatArray:
    return np.asarray(np.linalg.norm(np.diff(trajectory.positions_m, axis=0), axis=1))
