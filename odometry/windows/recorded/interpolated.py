"""Poses that were computed on straight lines between measured ones: they cut curves short."""

import numpy as np

from odometry.arrays import BoolArray, FloatArray, IntArray

MOST = 0.5  # share of the poses in motion, from which poses are taken for interpolated
STRAIGHT = 1e-3  # change of velocity, as a share of the speed
MOVING = 0.1  # of the ordinary fastest speed
FEWEST = 20  # poses in motion
REGULAR = 0.8  # share of the lines that last as long as usual, and of those that join: no drives
FEWEST_LINES, SHORTEST = 5, 5  # lines, and steps of the usual one: shorter lines cut little
AS_USUAL, ROWS = 0.25, 1.5  # by a share (sensors that keep no beat), or by so many rows


def on_lines(stamps_s: FloatArray, positions: FloatArray) -> tuple[BoolArray, BoolArray]:
    """Rows (M,) in motion, and rows (M,) on the line between their neighbours at even speed."""
    moving, on_line = np.zeros((2, len(stamps_s)), dtype=np.bool_)
    if len(stamps_s) < FEWEST:
        return moving, on_line
    velocity = np.diff(positions, axis=0) / np.diff(stamps_s)[:, None]
    speed = np.hypot(*velocity.T)
    slow = MOVING * np.quantile(speed, 0.9)
    moving[1:-1] = (speed[1:] > slow) & (speed[:-1] > 0)
    change = np.hypot(*np.diff(velocity, axis=0).T)
    on_line[1:-1] = change < STRAIGHT * np.maximum(speed[1:], slow)
    return moving, on_line


def interpolated(stamps_s: FloatArray, positions: FloatArray) -> BoolArray:
    """Which poses (M,) lie on straight lines between measured ones, where most of them do.

    The lines last equally long, and each begins where the one before ends, as between poses that
    were measured at a lower rate.

    Parameters
    ----------
    stamps_s : (M,)
        Ascending.
    positions : (M, 2)
    """
    between = np.zeros(len(stamps_s), dtype=np.bool_)
    for first, last in _regular_lines(stamps_s, positions):
        between[first + 1 : last] = True
    return between


def poses_per_measured_one(stamps_s: FloatArray, positions: FloatArray) -> float:
    """How many poses share the noise of a measured one; 1 where none is `interpolated`."""
    lines = _regular_lines(stamps_s, positions)
    return float(np.median(np.diff(lines, axis=1))) if len(lines) else 1.0


def _regular_lines(stamps_s: FloatArray, positions: FloatArray) -> IntArray:
    """First and last rows (L, 2) of the lines; none where poses were measured at most rows."""
    none = np.empty((0, 2), dtype=np.int64)
    moving, on_line = on_lines(stamps_s, positions)
    if moving.sum() < FEWEST or on_line[moving].mean() <= MOST:
        return none
    ends = line_ends(on_line)
    if len(ends) < FEWEST_LINES or np.median(np.diff(ends, axis=1)) < SHORTEST:
        return none
    lasts_s = np.diff(stamps_s[ends], axis=1)[:, 0]
    usual_s = np.median(lasts_s)
    near_s = max(AS_USUAL * usual_s, ROWS * float(np.median(np.diff(stamps_s))))
    regular = np.abs(lasts_s - usual_s) <= near_s
    joined = _joined(stamps_s, positions, ends)
    return ends[regular] if min(regular.mean(), joined.mean()) >= REGULAR else none


def _joined(stamps_s: FloatArray, positions: FloatArray, ends: IntArray) -> BoolArray:
    """Whether each line but the first (L - 1,) begins where the one before ends.

    That is at a row, or between two rows: then the step from one to the other takes a part of its
    time on each line, so that its velocity lies between those of the lines.
    """
    velocity = np.diff(positions, axis=0) / np.diff(stamps_s)[:, None]
    last, first = ends[:-1, 1], ends[1:, 0]
    before, step, after = velocity[last - 1], velocity[last], velocity[first]
    turn = after - before
    squared = np.maximum((turn**2).sum(axis=1), np.finfo(float).tiny)
    part = np.clip(((step - before) * turn).sum(axis=1) / squared, 0, 1)
    off = np.hypot(*(step - before - part[:, None] * turn).T)
    fastest = np.maximum(np.hypot(*before.T), np.hypot(*after.T))
    between = (first == last + 1) & (off < 10 * STRAIGHT * fastest)
    return np.asarray((first == last) | between)


def line_ends(on_line: BoolArray) -> IntArray:
    """First and last row (L, 2) of each line: the rows beside those on it."""
    edges = np.diff(on_line.astype(np.int8))
    return np.stack([np.flatnonzero(edges == 1), np.flatnonzero(edges == -1) + 1], axis=-1)
