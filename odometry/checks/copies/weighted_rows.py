"""How exactly a column is a weighted sum of neighbouring rows of another: averaged, filtered."""

from dataclasses import dataclass

import numpy as np

from odometry.arrays import FloatArray
from odometry.checks.copies.repetition import OF_NOISE, ORDER, ORDINARY, digit_of, noise_of

REACH = 10  # rows to each side
LEAST_ROWS = 400
MOST_ROWS = 3000
LEAST_CHANGES = 200
OWN_ROWS = 0.3  # of what own rows leave, that the source may leave


@dataclass(frozen=True)
class ByRows:
    """What a weighted sum of rows explains.

    Attributes
    ----------
    share : float
        Of the squares of the second differences.
    noise : float
        Standard deviation of a white noise that would leave the rest, rounding aside.
    """

    share: float
    noise: float


NOTHING = ByRows(0.0, np.inf)


def explained_by_rows(
    at_s: FloatArray, values: FloatArray, source_s: FloatArray, source: FloatArray
) -> ByRows:
    """How far values (N,) are a weighted sum of neighbouring rows of a source (S,).

    Any filter of a few rows, a delay of parts of a row or another rate is nearly such a sum.
    NOTHING where there are too few rows to say, and where values follow as well from their own.
    """
    inside = (at_s >= source_s[0]) & (at_s <= source_s[-1])
    at_s, values = at_s[inside][:MOST_ROWS], values[inside][:MOST_ROWS]
    if len(at_s) < LEAST_ROWS:
        return NOTHING
    at_rows = source if np.array_equal(at_s, source_s) else np.interp(at_s, source_s, source)
    rows = np.lib.stride_tricks.sliding_window_view(at_rows, 2 * REACH + 1)
    changes = np.diff(values[REACH:-REACH], ORDER)
    of_rows = np.diff(rows, ORDER, axis=0)
    sizes = np.abs(changes)
    if np.sum(sizes > 0) < LEAST_CHANGES:
        return NOTHING
    ordinary = sizes <= np.quantile(sizes[sizes > 0], ORDINARY)
    changes, of_rows = changes[ordinary], of_rows[ordinary]
    weights = np.linalg.lstsq(of_rows, changes, rcond=None)[0]
    left_square = float(np.mean((changes - of_rows @ weights) ** 2))
    noise = noise_of(max(left_square - OF_NOISE * digit_of(values) ** 2 / 12, 0.0))
    if noise > OWN_ROWS * left_by_own_rows(values):
        return NOTHING
    return ByRows(1 - left_square / float(np.mean(changes**2)), noise)


def left_by_own_rows(values: FloatArray) -> float:
    """What rows before and after leave of values (N,), root mean square: nothing of smooth ones.

    Smooth values, as of a simulation without noise, follow from any sensor of the same motion.
    """
    if len(values) < LEAST_ROWS:
        return np.inf
    values = values[:MOST_ROWS]
    rows = np.lib.stride_tricks.sliding_window_view(values, 2 * REACH + 1)
    others = np.delete(rows, REACH, axis=1)
    weights = np.linalg.lstsq(others, rows[:, REACH], rcond=None)[0]
    return float(np.sqrt(np.mean((rows[:, REACH] - others @ weights) ** 2)))
