"""How exactly a column is a weighted sum of neighbouring rows of another: averaged, republished."""

import numpy as np

from odometry.arrays import FloatArray
from odometry.checks.repetition import ORDER, ORDINARY

REACH = 10  # rows to each side
LEAST_ROWS = 400
MOST_ROWS = 3000
LEAST_CHANGES = 200


def explained_by_rows(
    at_s: FloatArray, values: FloatArray, source_s: FloatArray, source: FloatArray
) -> float:
    """Share of the squared second differences of values (N,) explained by rows of a source (S,).

    Any filter of a few rows, a delay of parts of a row or another rate is nearly such a sum. 0
    where there are too few rows to say.
    """
    inside = (at_s >= source_s[0]) & (at_s <= source_s[-1])
    at_s, values = at_s[inside][:MOST_ROWS], values[inside][:MOST_ROWS]
    if len(at_s) < LEAST_ROWS:
        return 0.0
    at_rows = source if np.array_equal(at_s, source_s) else np.interp(at_s, source_s, source)
    rows = np.lib.stride_tricks.sliding_window_view(at_rows, 2 * REACH + 1)
    changes = np.diff(values[REACH:-REACH], ORDER)
    of_rows = np.diff(rows, ORDER, axis=0)
    sizes = np.abs(changes)
    if np.sum(sizes > 0) < LEAST_CHANGES:
        return 0.0
    ordinary = sizes <= np.quantile(sizes[sizes > 0], ORDINARY)
    changes, of_rows = changes[ordinary], of_rows[ordinary]
    left = changes - of_rows @ np.linalg.lstsq(of_rows, changes, rcond=None)[0]
    return 1 - float(np.sum(left**2) / np.sum(changes**2))
