"""How far measured yaw rates are from those of the modes, counting what lasts."""

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from scipy.optimize import nnls

from odometry.arrays import FloatArray, IntArray
from odometry.modes.response import BLOCK_S, LEAST_VARIANCE, block_means
from odometry.modes.signals import STANDING_M_S, accelerations_m_s2
from odometry.modes.traction import lagged, twists_of
from odometry.run import Run

LASTING_S = 5.0  # for which an error of gains may stay the same: as long as a turn
NOT_MEASURED = 1.0  # [rad^2/s^2] where no run has a gyroscope: it says next to nothing


@dataclass(frozen=True)
class YawRateErrors:
    """Measured less predicted yaw rates of a stretch of one mode, and what the treads did.

    Attributes
    ----------
    step_s : float
    errors : (N,)
        [rad/s]
    accelerations_m_s2 : (N,)
    """

    step_s: float
    errors: FloatArray
    accelerations_m_s2: FloatArray


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


def yaw_rate_errors(
    stretches: Sequence[tuple[Run, IntArray]], gains: FloatArray, lag_s: float
) -> list[YawRateErrors]:
    """Errors while driving, over rows of runs, each without a gap, that have a gyroscope."""
    found = []
    for run, rows in stretches:
        if "gyro_z" not in run.odometry or len(rows) < 2:
            continue
        stamps_s = run.odometry.stamps_s[rows]
        speeds = run.odometry.stack("v_left", "v_right")[rows]
        asked = twists_of(gains, speeds, run.robot.track_width)[:, 2]
        errors = run.odometry["gyro_z"][rows] - lagged(asked, stamps_s, lag_s)
        accelerations = accelerations_m_s2(stamps_s, speeds)
        known = np.isfinite(errors) & (np.abs(speeds).max(axis=1) > STANDING_M_S)
        if known.sum() > 1:
            step_s = float(np.median(np.diff(stamps_s[known])))
            found.append(YawRateErrors(step_s, errors[known], accelerations[known]))
    return found


def estimated_yaw_rate_noise(stretches: Sequence[YawRateErrors]) -> YawRateNoise:
    """White noise with as much power as the errors have that last.

    Taken as noise of the variance that they have at each sample, fifty samples a second would say
    too much.
    """
    whole = [one for one in stretches if len(one.errors) * one.step_s >= BLOCK_S]
    if not whole:
        return YawRateNoise(NOT_MEASURED)
    step_s = float(np.median([one.step_s for one in whole]))
    # neighbours differ by white noise alone
    white = float(np.concatenate([np.diff(one.errors) ** 2 for one in whole]).mean() / 2)
    squares = np.concatenate([block_means(one.errors, one.step_s) ** 2 for one in whole])
    by = np.concatenate([block_means(one.accelerations_m_s2**2, one.step_s) for one in whole])
    (steady, growing), _ = nnls(np.column_stack([np.ones(len(by)), by]), squares)
    lasting = max(float(steady) - white * step_s / BLOCK_S, 0.0)
    variance = max(white + lasting * LASTING_S / step_s, LEAST_VARIANCE)
    return YawRateNoise(variance, float(growing) * LASTING_S / step_s / variance, lasting)
