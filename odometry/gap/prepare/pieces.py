"""Pieces of runs that are held out, dealt to folds or drawn together."""

from collections.abc import Sequence

import numpy as np

from odometry.arrays import BoolArray, IntArray
from odometry.windows.dense import DenseWindows

STANDING_M_S = 0.05  # mean tread speed of a piece below which it shows no effect


def pieces(scene: DenseWindows, part_s: float) -> IntArray:
    """Number (K,) of the piece of the run in which each window starts."""
    return np.asarray(np.floor(scene.start_s / part_s).astype(np.int64))


def numbered_pieces(scenes: Sequence[DenseWindows], part_s: float) -> IntArray:
    """The same (K of all,) for several scenes: no two share a number."""
    numbers, begin = [], 0
    for scene in scenes:
        here = pieces(scene, part_s)
        numbers.append(begin + here)
        begin += int(here.max(initial=-1)) + 1
    return np.concatenate(numbers)


def held_back(scene: DenseWindows, part_s: float, one_in: int) -> BoolArray:
    """Whether each window (K,) is held out: one piece in so many of those in which treads move.

    Stationary pieces agree with any model: an evaluation on them means nothing.
    """
    number = pieces(scene, part_s)
    ends_s = scene.pose_s[scene.windows[:, [0, -1]]]
    travel_m = np.diff(np.interp(ends_s, scene.time_s, scene.travel_m), axis=1)[:, 0]
    moving_m = STANDING_M_S * (ends_s[:, 1] - ends_s[:, 0])
    surplus_m = np.bincount(number, weights=travel_m - moving_m)
    moving = np.flatnonzero(surplus_m > 0)
    return np.asarray(np.isin(number, moving[one_in - 1 :: one_in]))
