"""What a Kalman filter needs beside predict and update: gates and constraints."""

import numpy as np
from scipy.stats import chi2

from odometry.arrays import FloatArray


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
