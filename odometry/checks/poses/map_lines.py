"""Positions that a program drew to the lines of a map."""

import numpy as np

from odometry.arrays import BoolArray, FloatArray

OFTEN = 10  # rows of one value, to the digits of the file
ON_LINES, ON_BOTH = 0.9, 0.3  # shares of the rows: on a line, and on a crossing or at rest
EACH = 0.05  # share of the rows on lines of either axis


def drawn_to_lines(positions: FloatArray) -> bool:
    """Whether nearly each position (M, 2) has one coordinate of a few values, and the other free.

    Rounding is of both coordinates.
    """
    on = np.stack([_often(column) for column in positions.T])
    either, both = on.any(axis=0), on.all(axis=0)
    alone = (on & ~both).mean(axis=1)
    return bool(either.mean() > ON_LINES and both.mean() < ON_BOTH and alone.min() > EACH)


def _often(values: FloatArray) -> BoolArray:
    _, of, counts = np.unique(values, return_inverse=True, return_counts=True)
    return np.asarray(counts[of] >= OFTEN)
