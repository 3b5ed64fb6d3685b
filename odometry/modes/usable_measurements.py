"""The measurements that depend on the modes, and how independent they are."""

import numpy as np

from odometry.arrays import FloatArray, IntArray
from odometry.modes.signals import Signals
from odometry.modes.standing_bias import moving
from odometry.windows.spans import touched

MOST_FASTER = 1.2  # times the fastest run of identification: beyond, models are not valid


def usable_measurements(signals: Signals, gap_ends: IntArray, fastest_m_s: float) -> FloatArray:
    """Measurements (N, m) where they depend on the modes.

    Not while stationary, nor in a gap, nor far above the speeds that the modes were identified at.
    """
    faster = np.abs(signals.tread_speeds_m_s).max(axis=1) > MOST_FASTER * fastest_m_s
    tells = moving(signals) & ~np.append(False, faster[:-1])
    tells &= ~touched(signals.gaps_s, signals.stamps_s, signals.stamps_s)
    tells[gap_ends] = False
    return np.where(tells[:, None], signals.measured, np.nan)


def independent_share(signals: Signals, errors_last_s: float) -> float:
    """Share of a measurement that is news, when errors of the models last."""
    measured_s = signals.stamps_s[np.isfinite(signals.measured).any(axis=1)]
    if errors_last_s <= 0 or len(measured_s) < 2:
        return 1.0
    return min(1.0, float(np.median(np.diff(measured_s))) / errors_last_s)
