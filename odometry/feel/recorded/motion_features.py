"""How a window was driven, its yaw response, and its motor currents."""

import numpy as np

from odometry.arrays import FloatArray

LEAST_SPEED_M_S = 0.02  # added below logarithms
TURN_SIGMA_RAD_S = 0.05  # turns of the treads below this determine no gain
USUAL_GAIN = 0.7  # of a skid-steer robot, where a window has no turn
LEAST_YAW_RATE_RAD_S = 0.003
LEAST_CURRENT_A = 0.3
SPEED_NAMES = ("log_speed", "log_speed_squared", "turning", "log_speed_change")
YAW_NAMES = ("yaw_gain", "log_yaw_residual", "log_yaw_ratio")
CURRENT_NAMES = ("log_current", "log_current_change")


def speed_covariates(treads_m_s: FloatArray) -> FloatArray:
    """How a window was driven (W, 4), SPEED_NAMES, from treads (W, N, 2).

    Vibration, currents and yaw rate all grow with speed: what depends on these is taken out.
    """
    speeds = np.abs(treads_m_s).mean(axis=2)
    log_speed = np.log(speeds.mean(axis=1) + LEAST_SPEED_M_S)
    turning = np.abs(np.diff(treads_m_s)[..., 0]).mean(axis=1)
    change = np.log(speeds.std(axis=1) + LEAST_SPEED_M_S)
    return np.column_stack([log_speed, log_speed**2, turning, change])


def yaw_features(
    yaw_rate_rad_s: FloatArray, treads_m_s: FloatArray, track_width_m: float, average: int
) -> FloatArray:
    """Yaw gain, its residual, and the ratio of the mean rates (W, 3), YAW_NAMES.

    Parameters
    ----------
    yaw_rate_rad_s : (W, N)
    treads_m_s : (W, N, 2)
    track_width_m : float
    average : int
        Samples over which rates are averaged, so that vibration is left out.
    """
    turning = _averaged(np.diff(treads_m_s)[..., 0] / track_width_m, average)
    measured = _averaged(yaw_rate_rad_s, average)
    weight = turning.shape[1] * TURN_SIGMA_RAD_S**2
    product, power = (measured * turning).sum(axis=1), (turning**2).sum(axis=1)
    gain = (product + USUAL_GAIN * weight) / (power + weight)
    left = (measured - gain[:, None] * turning).std(axis=1)
    ratio = np.log(np.abs(measured.mean(axis=1)) + LEAST_SPEED_M_S) - np.log(
        np.abs(turning.mean(axis=1)) + LEAST_SPEED_M_S
    )
    return np.column_stack([gain, np.log(left + LEAST_YAW_RATE_RAD_S), ratio])


def current_features(currents_a: FloatArray) -> FloatArray:
    """Mean and spread (W, 2), CURRENT_NAMES, of currents (W, N, 2) without their dropouts.

    In logarithms, so that a current over speed is their difference to a covariate. NaN where a
    window has no current.
    """
    there = np.isfinite(currents_a)
    count = there.sum(axis=1)
    known = np.where(there, currents_a, 0.0)
    means = np.divide(known.sum(axis=1), count, out=np.full(count.shape, np.nan), where=count > 0)
    squares = np.where(there, (currents_a - means[:, None]) ** 2, 0.0).sum(axis=1)
    spread = np.sqrt(squares / np.maximum(count, 1))
    sides = count > 0
    either = np.maximum(sides.sum(axis=1), 1)
    both = [np.where(sides, of, 0.0).sum(axis=1) / either for of in (means, spread)]
    features = np.log(np.column_stack(both) + LEAST_CURRENT_A)
    features[~sides.any(axis=1)] = np.nan
    return features


def _averaged(values: FloatArray, average: int) -> FloatArray:
    """Means (W, N // average) over so many samples."""
    parts = values.shape[1] // average
    return np.asarray(
        values[:, : parts * average].reshape(len(values), parts, average).mean(axis=2)
    )
