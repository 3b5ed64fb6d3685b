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
