"""Between which measured poses windows of a duration lie, and which are left out."""

from collections import Counter

import numpy as np

from odometry.arrays import FloatArray, IntArray
from odometry.windows.recorded.in_motion import moving_windows
from odometry.windows.recorded.record import FEW_POSES, STATIONARY, Record, straddling

LEAST_POSES = 3  # of a window
EDGE_S = 0.5  # of a run: a late or early pose must still lie within its odometry
UNEVEN = 0.25  # a window may be longer or shorter by this share
FEW = 0.1  # share of the windows that may be lost for having fewer poses than the others
LEAST_MOVING = 40  # windows: twice what a noise floor needs


def windows_of_poses(
    pose_s: FloatArray, record: Record, end_s: float, horizon_s: float
) -> tuple[IntArray, Counter[str]]:
    """Poses (K, n + 1) of windows, and how many were left out.

    n is what about nine windows in ten have, evenly chosen where there are more. Where the robot
    stands in most of them, these are left out, if enough others are there.
    """
    inside = (pose_s >= EDGE_S) & (pose_s <= end_s - EDGE_S)
    spans, stretch = [], record.stretch
    for number in np.unique(stretch):
        spans += _spans(pose_s, np.flatnonzero(inside & (stretch == number)), horizon_s)
    unbroken = np.array(_spans(pose_s, np.flatnonzero(inside), horizon_s), dtype=np.int64)
    left_out = straddling(record.breaks, *unbroken.reshape(-1, 2).T)
    firsts, lasts = np.array(spans, dtype=np.int64).reshape(-1, 2).T
    if not len(firsts):
        return np.empty((0, LEAST_POSES), dtype=np.int64), left_out
    steps = max(LEAST_POSES - 1, int(np.quantile(lasts - firsts, FEW)))
    kept = lasts - firsts >= steps
    left_out[FEW_POSES] += int(np.count_nonzero(~kept))
    moves = moving_windows(_ways_m(record, firsts[kept], lasts[kept]), LEAST_MOVING)
    left_out[STATIONARY] += int(np.count_nonzero(~moves))
    kept[kept] = moves  # the errors of others, all but nothing, would be what is usual
    chosen = np.rint(np.linspace(firsts[kept], lasts[kept], steps + 1, axis=1))
    return chosen.astype(np.int64), +left_out


def _ways_m(record: Record, firsts: IntArray, lasts: IntArray) -> FloatArray:
    """How far (2, K) poses and treads moved the robot between poses (K,)."""
    travel_m = record.travel_m[record.pose_samples]
    moved_m = np.hypot(*(record.poses[lasts, :2] - record.poses[firsts, :2]).T)
    return np.stack([moved_m, travel_m[lasts] - travel_m[firsts]])


def _spans(pose_s: FloatArray, poses: IntArray, horizon_s: float) -> list[tuple[int, int]]:
    """First and last pose of windows end to end, each as near the horizon as stamps allow."""
    found, at = [], 0
    while at < len(poses) - 1:
        lasts_s = pose_s[poses[at + 1 :]] - pose_s[poses[at]]
        end = int(np.argmin(np.abs(lasts_s - horizon_s)))
        if abs(lasts_s[end] - horizon_s) <= UNEVEN * horizon_s:
            found.append((int(poses[at]), int(poses[at + 1 + end])))
        at += end + 1
    return found
