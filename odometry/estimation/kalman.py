"""Predict and update of the extended Kalman filter of one robot, for the state of `transition`.

filterpy's own predict and update take two thirds of what a step may cost, and a step with a
gyroscope has two updates. These are the same sums without its records and checks; tests hold
them against filterpy, in which the members of a bank stay.
"""

import math
from typing import NamedTuple

from scipy.linalg.lapack import dposv, dpotrs

from odometry.arrays import FloatArray
from odometry.errors import EstimationError
from odometry.estimation.measurement import Gaussian, Measurement
from odometry.estimation.transition import STATES, UNCHANGED


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
