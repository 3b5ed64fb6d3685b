"""Predict and update of the extended Kalman filter of one robot, for the state of `transition`.

filterpy's own predict and update take two thirds of what a step may cost, and a step with a
gyroscope has two updates. These are the same sums without its records and checks; tests hold
them against filterpy, in which the members of a bank stay.
"""

import math
from typing import NamedTuple

import numpy as np
from scipy.linalg.lapack import dposv, dpotrs
from scipy.stats import chi2

from odometry.arrays import FloatArray, IntArray
from odometry.errors import EstimationError
from odometry.estimation.measurement import Gaussian, Measurement
from odometry.estimation.transition import (
    ALPHA_LEFT,
    ALPHA_RIGHT,
    STATES,
    UNCHANGED,
    Y_LEFT,
    Y_RIGHT,
    YAW,
)
from odometry.geometry.angles import wrap_one

UNKNOWN_RAD = 0.3  # of the heading's deviation: a way along it is measured 4.5 % too short


class Updated(NamedTuple):
    """State estimate after a measurement (m,).

    Attributes
    ----------
    mean, covariance : (9,), (9, 9)
    squared : float
        The normalised innovation squared.
    weighed : (m,)
        The inverse of the innovation's covariance times the innovation.
    """

    mean: FloatArray
    covariance: FloatArray
    squared: float
    weighed: FloatArray


def predicted(covariance: FloatArray, jacobian: FloatArray, half_noise: FloatArray) -> FloatArray:
    """Covariance (9, 9) at the end of a step: Chen 2023 eq. 7.

    Parameters
    ----------
    covariance : (9, 9)
        At its beginning.
    jacobian : (9, 9)
        Of the step.
    half_noise : (9, 9)
        Covariance that white noise adds over half of the step.

    Notes
    -----
    Half of the noise goes in before the step and half after it: the trapezium rule for the
    integral of F(s) Q F(s)^T. The first step of eq. 7 would make the answer depend on how
    finely time is cut.
    """
    carried: FloatArray = jacobian.dot(covariance + half_noise).dot(jacobian.T)
    carried += half_noise
    return carried


def updated(belief: Gaussian, measured: Measurement) -> Updated:
    """State estimate (9,), (9, 9) after a measurement: Chen 2023 eq. 14-16, in Joseph's form."""
    mean, covariance = belief
    residual, by_state, noise = measured
    shared = covariance.dot(by_state.T)
    expected = by_state.dot(shared)
    expected += noise
    factor, gain_transposed, failed = dposv(expected, shared.T)
    if failed:
        raise EstimationError(
            f"an innovation {residual.tolist()} of a covariance that is not positive definite; "
            "expected noise of measurements above the rounding errors of the estimate"
        )
    weighed = dpotrs(factor, residual)[0]
    gain = gain_transposed.T
    remaining = UNCHANGED - gain.dot(by_state)
    joseph = remaining.dot(covariance).dot(remaining.T)
    joseph += gain.dot(noise).dot(gain_transposed)
    return Updated(
        mean + shared.dot(weighed),
        (joseph + joseph.T.copy()) * 0.5,
        float(residual.dot(weighed)),
        weighed,
    )


def updated_beside(belief: Gaussian, measured: Measurement, kept: IntArray) -> Updated:
    """As `updated`, but the states `kept` (k,) and their covariance stay as they are.

    They count for what is expected, and their covariance with the others changes (the consider
    filter of Schmidt, 1966).
    """
    mean, covariance = belief
    residual, by_state, noise = measured
    shared = covariance.dot(by_state.T)
    expected = by_state.dot(shared) + noise
    gain = np.linalg.solve(expected, shared.T).T
    gain[kept] = 0.0
    remaining = UNCHANGED - gain.dot(by_state)
    joseph = remaining.dot(covariance).dot(remaining.T) + gain.dot(noise).dot(gain.T)
    weighed = np.linalg.solve(expected, residual)
    return Updated(
        mean + gain.dot(residual), (joseph + joseph.T) / 2, float(residual.dot(weighed)), weighed
    )


def updated_by_number(
    belief: Gaussian, shared: FloatArray, residual: float, variance: float
) -> Gaussian:
    """State estimate after one number, whose noise is not far below the predicted deviation.

    The covariance loses the square of one column, so that it stays symmetric to the last digit.

    Parameters
    ----------
    belief : (9,), (9, 9)
    shared : (9,)
        Covariance of the state and the number.
    residual, variance : float
        Innovation, and its variance: that of the prediction plus the noise.
    """
    mean, covariance = belief
    column = (shared / math.sqrt(variance)).reshape(STATES, 1)
    return mean + shared * (residual / variance), covariance - column.dot(column.T)


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
