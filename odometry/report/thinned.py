"""Long lines with fewer points that look the same: a page costs what it shows, not what ran."""

import numpy as np

from odometry.arrays import FloatArray

LONG = 20_000  # points; shorter lines are drawn as they are
PARTS = 2500  # more than twice the pixels of a page's width


def thinned(*columns: FloatArray) -> tuple[FloatArray, ...]:
    """Columns (N,) of a line with the rows that it needs at the size of a page.

    Of each of PARTS parts of a long line the first row stays, and the rows of the least and the
    greatest value of each column; the last row stays, and a break (NaN) in each part that has one.

    Parameters
    ----------
    columns : (N,) each
        Rising stamps, or the coordinates of places; NaN breaks the line.
    """
    count = len(columns[0])
    if count <= LONG:
        return columns
    width = -(-count // PARTS)
    starts = np.arange(0, count, width)
    rows = [starts, np.array([count - 1])]
    for column in columns:
        padded = np.pad(column, (0, len(starts) * width - count), mode="edge")
        parts = padded.reshape(-1, width)
        broken = np.isnan(parts)
        least = np.where(broken, np.inf, parts).argmin(axis=1)
        greatest = np.where(broken, -np.inf, parts).argmax(axis=1)
        rows += [starts + of for of in (least, greatest, broken.argmax(axis=1))]
    kept = np.unique(np.minimum(np.concatenate(rows), count - 1))
    return tuple(column[kept] for column in columns)
