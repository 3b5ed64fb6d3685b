"""How long each recorded speed is held, for effects on commands that have a memory."""

import numpy as np

from odometry.arrays import BoolArray, FloatArray

LONGEST_STEP_S = 1.0  # after a longer pause the treads have caught up


def held_spans(time_s: FloatArray) -> tuple[FloatArray, BoolArray]:
    """How long (N,) samples stamped (N,) are held [s], and where (N,) a new record starts.

    A record starts at the first sample, where stamps go back (the next of several runs) and after
    a pause; the last sample before it is held for the usual period.
    """
    steps_s = np.diff(time_s)
    period_s = float(np.median(steps_s[steps_s > 0])) if (steps_s > 0).any() else 1.0
    pause = (steps_s < 0) | (steps_s > max(LONGEST_STEP_S, 2 * period_s))
    starts = np.concatenate([[True], pause])
    return np.where(np.append(pause, True), period_s, np.append(steps_s, 0.0)), starts


def late_speeds(
    speeds: FloatArray, held_s: FloatArray, starts: BoolArray, delay_s: float
) -> FloatArray:
    """Mean speeds (N, T) over each sample of those (N, T) of T treads recorded `delay_s` earlier.

    Exact for held commands: differences of travel. Before the first sample of a record, and after
    its last, speeds are as in it.
    """
    late = np.array(speeds, dtype=np.float64)
    for rows in np.split(np.arange(len(late)), np.flatnonzero(starts)[1:]):
        late[rows] = _of_record(late[rows], held_s[rows], delay_s)
    return late


def _of_record(speeds: FloatArray, held_s: FloatArray, delay_s: float) -> FloatArray:
    ends_s = np.concatenate([[0.0], np.cumsum(held_s)])
    beyond_s = abs(delay_s)
    known_s = np.concatenate([[-beyond_s], ends_s, [ends_s[-1] + beyond_s]])
    moved = held_s > 0
    late = speeds.copy()
    for tread, own in enumerate(speeds.T):
        steps_m = np.concatenate([[beyond_s * own[0]], own * held_s, [beyond_s * own[-1]]])
        travel_m = np.concatenate([[0.0], np.cumsum(steps_m)])
        at_m = np.interp(ends_s - delay_s, known_s, travel_m)
        late[moved, tread] = (np.diff(at_m) / np.where(moved, held_s, 1.0))[moved]
    return late
