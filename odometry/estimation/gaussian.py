"""What a Kalman filter needs beside predict and update: gates, constraints, bounds of the state."""

import math

import numpy as np
from scipy.stats import chi2

from odometry.arrays import FloatArray
from odometry.estimation.measurement import Gaussian
from odometry.estimation.transition import ALPHA_LEFT, ALPHA_RIGHT, STATES, Y_LEFT, Y_RIGHT, YAW
from odometry.geometry.angles import wrap_one


def gate_threshold(probability: float, dimension: int) -> float:
    """Normalised innovation squared that a true measurement exceeds with 1 - `probability`."""
    return float(chi2.ppf(probability, dimension))


def normalised_squared(residual: FloatArray, covariance: FloatArray) -> float:
    """Squared Mahalanobis length of a residual (n,) under a covariance (n, n)."""
    return float(residual @ np.linalg.solve(covariance, residual))


def project_into(
    mean: FloatArray, covariance: FloatArray, directions: FloatArray, least: FloatArray
) -> FloatArray:
    """The most probable mean with `directions @ mean >= least`, for two constraints.

    Parameters
    ----------
    mean, covariance : (n,), (n, n)
    directions, least : (2, n), (2,)

    Returns
    -------
    (n,)
        On neither bound where `mean` obeys, on one where that suffices, else on both.
    """
    for direction, bound in zip(directions, least, strict=True):
        projected = project_above(mean, covariance, direction, float(bound))
        if np.all(directions @ projected >= least - 1e-12):
            return projected
    gain = covariance @ directions.T
    shortfall = least - directions @ mean
    return np.asarray(mean + gain @ np.linalg.lstsq(directions @ gain, shortfall, rcond=None)[0])


def project_above(
    mean: FloatArray, covariance: FloatArray, direction: FloatArray, least: float
) -> FloatArray:
    """The most probable mean with `direction @ mean >= least`.

    Parameters
    ----------
    mean, covariance : (n,), (n, n)
    direction : (n,)
    least : float

    Returns
    -------
    (n,)
        `mean` itself where it obeys; else its projection in the metric of the covariance
        (Simon 2010, IET Control Theory and Applications 4(8), eq. 22).
    """
    shortfall = least - float(direction @ mean)
    if shortfall <= 0:
        return mean
    gain = covariance @ direction
    return np.asarray(mean + gain * (shortfall / float(direction @ gain)))


SIDES = np.zeros((2, STATES))
SIDES[0, Y_LEFT], SIDES[1, Y_RIGHT] = 1.0, -1.0
LEAST_SIDE = 0.05  # of the track width; y_left and -y_right are kept above it
LEAST_ALPHA = 0.05


def bounded(mean: FloatArray, covariance: FloatArray, track_width: float) -> Gaussian:
    """Yaw in (-pi, pi], ICRs on their own sides of the robot, slip factors above zero.

    Parameters
    ----------
    mean : (9,)
        Of an update; it is changed in place where only its yaw or a slip factor is out of bounds.
    covariance : (9, 9)
    track_width : float
        [m]

    Returns
    -------
    (9,), (9, 9)
        ICRs beyond their side are projected by the covariance, which stays as it is.
    """
    _, _, yaw, y_left, y_right, _, _, alpha_left, alpha_right = mean.tolist()
    if abs(yaw) > math.pi:
        mean[YAW] = wrap_one(yaw)
    least_m = LEAST_SIDE * track_width
    if y_left < least_m or y_right > -least_m:
        mean = project_into(mean, covariance, SIDES, np.full(2, least_m))
    if alpha_left < LEAST_ALPHA or alpha_right < LEAST_ALPHA:
        mean[ALPHA_LEFT] = max(alpha_left, LEAST_ALPHA)
        mean[ALPHA_RIGHT] = max(alpha_right, LEAST_ALPHA)
    return mean, covariance
