"""How far measured yaw rates are from those of the modes, counting what lasts."""

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from scipy.optimize import nnls

from odometry.arrays import BoolArray, FloatArray, IntArray
from odometry.modes.models.response import BLOCK_S, LEAST_VARIANCE, block_means, lagged
from odometry.modes.models.traction import twists_of
from odometry.modes.recorded.bank_inputs import STANDING_M_S, accelerations_m_s2, yaw_rates_of
from odometry.recording.run import Run

LASTING_S = 5.0  # for which an error of gains may stay the same: as long as a turn
NOT_MEASURED = 1.0  # [rad^2/s^2] where no run has a gyroscope: it hardly counts


@dataclass(frozen=True)
class YawRateStretch:
    """A stretch of one mode with a gyroscope.

    Attributes
    ----------
    stamps_s : (N,)
    tread_speeds_m_s : (N, 2)
    yaw_rates : (N,)
        [rad/s]
    driving : (N,)
        Whether a yaw rate was measured while a tread turned; K are.
    step_s : float
        Between these.
    accelerations_m_s2 : (K,)
        Of the treads.
    track_width : float
        [m]
    """

    stamps_s: FloatArray
    tread_speeds_m_s: FloatArray
    yaw_rates: FloatArray
    driving: BoolArray
    step_s: float
    accelerations_m_s2: FloatArray
    track_width: float

    def errors(self, gains: FloatArray, lag_s: float) -> FloatArray:
        """Measured less predicted yaw rates (K,) while driving."""
        commanded = twists_of(gains, self.tread_speeds_m_s, self.track_width)[:, 2]
        return (self.yaw_rates - lagged(commanded, self.stamps_s, lag_s))[self.driving]


@dataclass(frozen=True)
class YawRateNoise:
    """Variance of a yaw rate while the treads are steady, and its growth by acceleration.

    Attributes
    ----------
    variance : float
        [rad^2/s^2]
    growth : float
        Part of it that is added for each (m/s^2)^2.
    lasting : float
        Variance of what lasts of the errors [rad^2/s^2].
    """

    variance: float
    growth: float = 0.0
    lasting: float = 0.0

    def variances(self, accelerations_m_s2: FloatArray) -> FloatArray:
        """At accelerations (N,) of the treads."""
        return self.variance * (1 + self.growth * accelerations_m_s2**2)


def yaw_rate_stretch_of(run: Run, rows: IntArray) -> YawRateStretch | None:
    """Rows of a run without a gap; None without a gyroscope, or where it did not drive."""
    measured = yaw_rates_of(run)
    if measured is None:
        return None
    stamps_s = run.odometry.stamps_s[rows]
    speeds = run.odometry.stack("v_left", "v_right")[rows]
    yaw_rates = measured[rows]
    driving = np.isfinite(yaw_rates) & (np.abs(speeds).max(axis=1) > STANDING_M_S)
    if driving.sum() < 2:
        return None
    step_s = float(np.median(np.diff(stamps_s[driving])))
    accelerations = accelerations_m_s2(stamps_s, speeds)[driving]
    width = run.robot.track_width
    return YawRateStretch(stamps_s, speeds, yaw_rates, driving, step_s, accelerations, width)


def estimated_yaw_rate_noise(
    stretches: Sequence[tuple[YawRateStretch, FloatArray]],
) -> YawRateNoise:
    """White noise with as much power as the errors (K,) of stretches have that last.

    Taken as noise of the variance that they have at each sample, fifty samples a second would count
    too much.
    """
    whole = [(one, errors) for one, errors in stretches if len(errors) * one.step_s >= BLOCK_S]
    if not whole:
        return YawRateNoise(NOT_MEASURED)
    step_s = float(np.median([one.step_s for one, _ in whole]))
    # neighbours differ by white noise alone
    white = float(np.concatenate([np.diff(errors) ** 2 for _, errors in whole]).mean() / 2)
    squares = np.concatenate([block_means(errors, one.step_s) ** 2 for one, errors in whole])
    by = np.concatenate([block_means(one.accelerations_m_s2**2, one.step_s) for one, _ in whole])
    (steady, growing), _ = nnls(np.column_stack([np.ones(len(by)), by]), squares)
    lasting = max(float(steady) - white * step_s / BLOCK_S, 0.0)
    variance = max(white + lasting * LASTING_S / step_s, LEAST_VARIANCE)
    return YawRateNoise(variance, float(growing) * LASTING_S / step_s / variance, lasting)
