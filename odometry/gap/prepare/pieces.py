"""Pieces of runs that are held out, dealt to folds or drawn together."""

from collections.abc import Sequence

import numpy as np

from odometry.arrays import IntArray
from odometry.windows.dense.dense import DenseWindows


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
