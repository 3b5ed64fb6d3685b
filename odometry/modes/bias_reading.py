"""The bias of the gyroscope where the modes do not matter: from rest, or from headings."""

from collections.abc import Mapping
from dataclasses import dataclass

import numpy as np

from odometry.arrays import BoolArray, FloatArray
from odometry.modes.modes_config import ModesConfig
from odometry.modes.signals import BIAS_SIGMA_RAD_S, Signals
from odometry.modes.standing_bias import standing_biases

JUMP_SIGMAS = 4.0  # from the estimated bias: farther off it is another one


@dataclass(frozen=True)
class BiasReading:
    """A bias that was read.

    Attributes
    ----------
    bias_rad_s, variance : float
        Mean and its variance.
    tolerance_rad_s : float
        An estimate that is no farther off stays: models of modes turn as much too far on straights.
    """

    bias_rad_s: float
    variance: float
    tolerance_rad_s: float = 0.0


def bias_readings(signals: Signals) -> dict[int, BiasReading]:
    """By row: from the headings of measured poses, and where the robot stood from that."""
    found = {}
    check = signals.heading_check
    if check is not None:
        rows = np.searchsorted(signals.stamps_s, check.stamps_s)
        for place in check.bias_windows:
            if rows[place] < len(signals):
                variance = float(check.bias_sigma_rad_s[place]) ** 2
                found[int(rows[place])] = BiasReading(
                    float(check.bias_rad_s[place]), variance, BIAS_SIGMA_RAD_S
                )
    return found | {row: BiasReading(*of) for row, of in standing_biases(signals).items()}


def with_reading(
    mean: FloatArray, covariance: FloatArray, read: BiasReading, independent: float
) -> tuple[FloatArray, FloatArray]:
    """Mean (n,) and covariance (n, n) over all modes with a reading; the bias is the last entry.

    The reading is weighed with the estimate; where the two are JUMP_SIGMAS apart the bias is
    another one, and what was believed counts no more. A filter holds the variance of the bias less
    by the share `independent` (see `start` of the modes).
    """
    mean, covariance = mean.copy(), covariance.copy()
    believed = covariance[-1, -1] / independent
    off = read.bias_rad_s - mean[-1]
    if abs(off) <= read.tolerance_rad_s:
        return mean, covariance
    gain = believed / (believed + read.variance)
    if off**2 > JUMP_SIGMAS**2 * (believed + read.variance):
        gain, believed = 1.0, np.inf
    mean[-1] += gain * off
    covariance[-1, -1] = independent / (1 / believed + 1 / read.variance)
    return mean, covariance


def bias_is_open(
    biases_rad_s: FloatArray, readings: Mapping[int, BiasReading], config: ModesConfig | None = None
) -> BoolArray:
    """Where (N,) the estimated bias (N,) of the filters lies beyond its expected range.

    That is 0, and after a reading what was read. A mode that is not the true one explains a turn
    by such a bias, and nothing but that mode is evidence of one.
    """
    expected = np.zeros(len(biases_rad_s))
    for row in sorted(readings):
        expected[row:] = readings[row].bias_rad_s
    least = (config or ModesConfig()).bias_sigmas * BIAS_SIGMA_RAD_S
    return np.asarray(np.abs(biases_rad_s - expected) > least)
