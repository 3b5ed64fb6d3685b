"""Tread speeds that repeat a stretch of earlier ones to the last digit, beside other turns."""

import numpy as np

from odometry.arrays import FloatArray, IntArray
from odometry.checks.evidence.evidence import Evidence
from odometry.checks.statistics.relation import relation
from odometry.checks.turns.measured_turns import measured_turns
from odometry.windows.recorded.spans import touched

# Rows of a stretch, and of them those in which both speeds are new ones, and those that differ: of
# coarse encoders a few speeds take turns. No stretch of 75 real recordings repeats another one.
ROWS, CHANGING = 20, 8
TIMES, LEAST_WINDOWS = 3.0, 4  # the usual residual of turns, and windows that have it
SEED = 0  # of the weights by which stretches are compared


def repeated_rows(evidence: Evidence) -> str:
    """Words where rows were written again: turns then go on otherwise; "" elsewhere."""
    rows = _repeated(evidence.run.odometry.stack("v_left", "v_right"))
    if not len(rows):
        return ""
    spans_s = evidence.stamps_s[rows[:, None] + np.array([0, ROWS - 1])]
    if not any(_apart(evidence, spans_s)):
        return ""
    return (
        f"{len(np.unique(rows[:, None] + np.arange(ROWS)))} rows of odometry.csv repeat the tread "
        f"speeds of earlier ones to the last digit (first at "
        f"{evidence.run_time_s(spans_s[0, 0]):.1f} s), while other sensors do not"
    )


def _repeated(speeds: FloatArray) -> IntArray:
    """First rows (K,) of stretches of the speeds (N, 2) that are equal to an earlier stretch."""
    count = len(speeds) - ROWS + 1
    if count < 2:
        return np.empty(0, dtype=np.int64)
    new = np.insert((np.diff(speeds, axis=0) != 0).all(axis=1), 0, False)
    summed = np.cumsum(np.insert(new & (speeds != 0).all(axis=1), 0, False))
    first = np.flatnonzero(summed[ROWS:] - summed[:-ROWS] >= CHANGING)
    weights = np.random.default_rng(SEED).standard_normal((ROWS, 2))
    sums = sum(speeds[row : row + count] @ weights[row] for row in range(ROWS))
    _, earliest, same = np.unique(sums[first], return_index=True, return_inverse=True)
    again = first[earliest[same] != np.arange(len(first))]
    both = speeds[:, 0] + 1j * speeds[:, 1]
    of_rows = np.sort(both[again[:, None] + np.arange(ROWS)], axis=1)
    return np.asarray(again[(np.diff(of_rows, axis=1) != 0).sum(axis=1) >= CHANGING])


def _apart(evidence: Evidence, spans_s: FloatArray) -> list[bool]:
    """Whether turns of each sensor part from the treads in these spans, by far more than usual."""
    found = []
    for turns in measured_turns(evidence):
        m = turns.motion
        inside = touched(spans_s, m.start_s, m.end_s)
        fit = relation(np.where(inside, np.nan, turns.target), m.left_m, m.right_m, m.lasts_s)
        if fit is None:
            continue
        treads = np.stack([m.left_m, m.right_m, m.lasts_s], axis=-1)
        off = np.abs(turns.target - treads @ fit.coefficients)
        known = np.isfinite(off)
        odd = known & inside & (off > TIMES * np.quantile(off[known & ~inside], 0.9))
        found.append(bool(odd.sum() >= LEAST_WINDOWS))
    return found
