"""Poses that lie away from their neighbours and come back."""

import numpy as np

from odometry.arrays import BoolArray, FloatArray

REACH = 5  # poses to each side whose median is compared
LEAST_M = 0.5
TIMES = 8.0  # the usual distance from that median
LONGEST = 3  # poses of an outlier: what lasts longer is a jump


def pose_outliers(positions: FloatArray) -> BoolArray:
    """Which positions (M, 2) are far from the median of their neighbours, for a few poses.

    While the robot drives, the median of its neighbours is where it is: only what leaves the way
    and comes back differs from it.
    """
    count = len(positions)
    if count < 2 * REACH + 1:
        return np.zeros(count, dtype=np.bool_)
    padded = np.concatenate(
        [np.repeat(positions[:1], REACH, 0), positions, np.repeat(positions[-1:], REACH, 0)]
    )
    around = np.lib.stride_tricks.sliding_window_view(padded, 2 * REACH + 1, axis=0)
    away = np.hypot(*(positions - np.median(around, axis=-1)).T)
    step = float(np.quantile(np.hypot(*np.diff(positions, axis=0).T), 0.9))
    usual = 1.4826 * float(np.median(away))
    far = away > max(TIMES * usual, 3 * step, LEAST_M * _unit(step))
    edges = np.diff(np.concatenate([[False], far, [False]]).astype(np.int8))
    begins, ends = np.flatnonzero(edges == 1), np.flatnonzero(edges == -1)
    found = np.zeros(count, dtype=np.bool_)
    for begin, end in zip(begins, ends, strict=True):
        short = end - begin <= LONGEST
        found[begin:end] = short and _comes_back(positions, away, int(begin), int(end))
    return found


def _comes_back(positions: FloatArray, away: FloatArray, begin: int, end: int) -> bool:
    """Whether the poses beside a span are near each other: else the robot drove on."""
    if begin == 0 or end == len(positions):
        return True
    apart = float(np.hypot(*(positions[end] - positions[begin - 1])))
    return apart < float(away[begin:end].max())


def _unit(step: float) -> float:
    """A metre in the unit of the positions, as far as their steps tell: it may be wrong."""
    return 1.0 if 1e-3 < step < 10 else step
