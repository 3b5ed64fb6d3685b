"""The bias of the gyroscope while the robot stands: what it reads is the bias."""

from dataclasses import dataclass

import numpy as np

from odometry.arrays import BoolArray, FloatArray
from odometry.modes.signals import STANDING_M_S, Signals

SETTLES_S = 0.5  # after the treads stopped
LEAST_S = 0.5  # of what is read after that
MOST_RAD_S = 0.1  # of a bias: more is another fault, or the robot turns though no tread does
JUMP_SIGMAS = 4.0  # from the bias believed: it is another one since


@dataclass(frozen=True)
class StandingBias:
    """What the gyroscope read while the robot stood.

    Attributes
    ----------
    bias_rad_s, variance : float
        Mean and its variance.
    """

    bias_rad_s: float
    variance: float


def moving(signals: Signals) -> BoolArray:
    """Where (N,) a tread turned before the stamp: who stands learns nothing of the terrain."""
    turning = np.abs(signals.tread_speeds_m_s).max(axis=1) > STANDING_M_S
    return np.append(False, turning[:-1])


def standing_biases(signals: Signals) -> dict[int, StandingBias]:
    """By the last row of each stand that is long enough to tell; none of a value that is held.

    The yaw rate is the last measured entry.
    """
    found = {}
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
            found[int(stand[-1])] = StandingBias(bias, variance)
    return found


def after_standing(
    mean: FloatArray, covariance: FloatArray, stood: StandingBias, independent: float
) -> tuple[FloatArray, FloatArray]:
    """Mean (n,) and covariance (n, n) over all modes after a stand; the bias is the last entry.

    What the gyroscope read is weighed with what is believed; where the two are JUMP_SIGMAS apart
    the bias is another one, and what was believed counts no more. A filter holds the variance of
    the bias less by the share `independent` (see `start` of the modes).
    """
    mean, covariance = mean.copy(), covariance.copy()
    believed = covariance[-1, -1] / independent
    off = stood.bias_rad_s - mean[-1]
    gain = believed / (believed + stood.variance)
    if off**2 > JUMP_SIGMAS**2 * (believed + stood.variance):
        gain, believed = 1.0, np.inf
    mean[-1] += gain * off
    covariance[-1, -1] = independent / (1 / believed + 1 / stood.variance)
    return mean, covariance
