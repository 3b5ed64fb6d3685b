"""The bias of the gyroscope while the robot is stationary: its reading."""

import numpy as np

from odometry.arrays import BoolArray
from odometry.modes.signals import STANDING_M_S, Signals

SETTLES_S = 0.5  # after the treads stopped
LEAST_S = 0.5  # of what is read after that
MOST_RAD_S = 0.1  # of a bias: more is another fault, or the robot turns though no tread does


def moving(signals: Signals) -> BoolArray:
    """Where (N,) a tread turned before the stamp: at rest nothing depends on the terrain."""
    turning = np.abs(signals.tread_speeds_m_s).max(axis=1) > STANDING_M_S
    return np.append(False, turning[:-1])


def standing_biases(signals: Signals) -> dict[int, tuple[float, float]]:
    """Mean and its variance, by the last row of each rest that is long enough.

    None of a value that is held. The yaw rate is the last measured entry.
    """
    found: dict[int, tuple[float, float]] = {}
    rows = np.flatnonzero(~moving(signals))
    for stand in np.split(rows, np.flatnonzero(np.diff(rows) > 1) + 1) if len(rows) else []:
        stamps_s = signals.stamps_s[stand]
        readings = signals.measured[stand, -1]
        read = np.isfinite(readings) & (stamps_s >= stamps_s[0] + SETTLES_S)
        readings = readings[read]
        if len(readings) < 2 or np.ptp(stamps_s[read]) < LEAST_S:
            continue
        bias, variance = float(readings.mean()), float(readings.var(ddof=1)) / len(readings)
        if variance > 0 and abs(bias) < MOST_RAD_S:
            found[int(stand[-1])] = (bias, variance)
    return found
