"""What a sensor measures less what the filter expects, its derivative and its noise."""

import math
from typing import NamedTuple

import numpy as np

from odometry.arrays import BoolArray, FloatArray
from odometry.estimation.noise_scale import huber_factor
from odometry.estimation.transition import (
    ALPHA_LEFT,
    ALPHA_RIGHT,
    GYRO_BIAS,
    STATES,
    X_ICR,
    Y_LEFT,
    Y_RIGHT,
    YAW,
    X,
    Y,
)
from odometry.geometry.angles import wrap_one

OF_POSE = np.eye(3, STATES)  # Chen 2023 eq. 13
Place = tuple[float, float]
Gaussian = tuple[FloatArray, FloatArray]


class Measurement(NamedTuple):
    """One measurement compared with the state estimate.

    Attributes
    ----------
    residual : (m,)
        Measured less expected; an angle in (-pi, pi].
    jacobian : (m, 9)
        Derivative of what is expected by the state.
    covariance : (m, m)
        Of the measurement.
    """

    residual: FloatArray
    jacobian: FloatArray
    covariance: FloatArray

    def part(self, chosen: BoolArray) -> "Measurement":
        """Only the chosen entries (m,) of bool."""
        return Measurement(
            self.residual[chosen],
            self.jacobian[chosen],
            self.covariance[np.ix_(chosen, chosen)],
        )


class MeasuredNumber(NamedTuple):
    """A measurement of one number compared with the state estimate.

    Attributes
    ----------
    residual : float
        Measured less expected.
    by_state : (9,)
        Derivative of what is expected by the state.
    """

    residual: float
    by_state: FloatArray


def reference_point(mean: FloatArray, lever_m: Place) -> FloatArray:
    """Place (2,) of a point `lever_m` of the robot frame in the reference frame."""
    cosine, sine = math.cos(mean[YAW]), math.sin(mean[YAW])
    ahead, aside = lever_m
    return np.array(
        [
            mean[X] + cosine * ahead - sine * aside,
            mean[Y] + sine * ahead + cosine * aside,
        ]
    )


def pose_measurement(
    mean: FloatArray, pose: FloatArray, covariance: FloatArray, lever_m: Place
) -> Measurement:
    """Of a measured pose, any part of which may be NaN (Chen 2023 eq. 12-13).

    Parameters
    ----------
    mean : (9,)
    pose : (3,)
        x, y of the reference point [m], yaw of the robot [rad].
    covariance : (3, 3)
    lever_m : (x, y)
        Place of the reference point in the robot frame.
    """
    x, y, yaw = mean[:3].tolist()
    at_x, at_y, at_yaw = pose.tolist()
    jacobian = OF_POSE
    aside_x, aside_y = 0.0, 0.0
    if lever_m != (0.0, 0.0):
        cosine, sine = math.cos(yaw), math.sin(yaw)
        aside_x = cosine * lever_m[0] - sine * lever_m[1]
        aside_y = sine * lever_m[0] + cosine * lever_m[1]
        jacobian = OF_POSE.copy()
        jacobian[0, YAW], jacobian[1, YAW] = -aside_y, aside_x
    turn = at_yaw - yaw
    if math.isfinite(turn):
        turn = wrap_one(turn)
    away_x, away_y = at_x - x - aside_x, at_y - y - aside_y
    measured = Measurement(np.array([away_x, away_y, turn]), jacobian, covariance)
    if math.isfinite(away_x + away_y + turn):
        return measured
    return measured.part(np.isfinite(measured.residual))


def turned_by_treads(mean: FloatArray, left: float, right: float) -> float:
    """Yaw rate of the treads [rad/s]: their difference after slip over y_left - y_right.

    Of the mean (9,) of the state and tread speeds [m/s].
    """
    _, _, _, y_left, y_right, _, _, alpha_left, alpha_right = mean.tolist()
    return float((alpha_right * right - alpha_left * left) / (y_left - y_right))


def tread_yaw_rate(mean: FloatArray, tread_speeds: FloatArray, yaw_rate: float) -> MeasuredNumber:
    """Of the gyroscope's yaw rate against that of the treads, which has the noise.

    Expected of the gyroscope: (alpha_right v_right - alpha_left v_left) / (y_left - y_right)
    plus its bias.

    Parameters
    ----------
    mean : (9,)
    tread_speeds : (2,)
        [m/s]
    yaw_rate : float
        [rad/s]
    """
    left, right = tread_speeds.tolist()
    _, _, _, y_left, y_right, _, bias, alpha_left, alpha_right = mean.tolist()
    width = y_left - y_right
    omega = (alpha_right * right - alpha_left * left) / width
    by_width, by_left, by_right = -omega / width, -left / width, right / width
    by_state = np.array([0.0, 0.0, 0.0, by_width, -by_width, 0.0, 1.0, by_left, by_right])
    return MeasuredNumber(yaw_rate - omega - bias, by_state)


def variance_of_slip_factors(by_state: FloatArray, covariance: FloatArray) -> float:
    """Variance of the treads' yaw rate by what is not known of slip factors.

    A yaw rate determines slip factors and y_left - y_right only as one ratio: where no pose gave
    how far the robot moves, it teaches the difference alone.
    """
    by_slip = by_state[ALPHA_LEFT:]
    return float(by_slip.dot(covariance[ALPHA_LEFT:, ALPHA_LEFT:]).dot(by_slip))


def weighed_down(measured: Measurement, covariance: FloatArray) -> Measurement:
    """The same with more noise of each number that lies beyond two standard deviations (Huber).

    Parameters
    ----------
    measured : Measurement
        Of m numbers, whose noise is independent.
    covariance : (9, 9)
        Of the state.
    """
    noise = np.diag(measured.covariance)
    variances = np.sum((measured.jacobian @ covariance) * measured.jacobian, axis=1) + noise
    factors = map(huber_factor, measured.residual.tolist(), variances.tolist())
    return measured._replace(covariance=np.diag(noise * np.fromiter(factors, float, len(noise))))


def velocity_measurement(
    mean: FloatArray,
    velocity: FloatArray,
    tread_speeds: FloatArray,
    yaw_rate: float,
    covariance: FloatArray,
) -> Measurement:
    """Of a measured v_x, v_y [m/s] and omega [rad/s], any part of which may be NaN.

    Parameters
    ----------
    mean : (9,)
    velocity : (3,)
    tread_speeds : (2,)
        Before slip [m/s].
    yaw_rate : float
        Of the gyroscope [rad/s]; where it is NaN, the treads turn the robot.
    covariance : (3, 3)
    """
    y_left, y_right, x_icr, bias, alpha_left, alpha_right = mean[Y_LEFT:].tolist()
    left, right = tread_speeds.tolist()
    by_omega = np.zeros(STATES)
    if math.isnan(yaw_rate):
        width = y_left - y_right
        omega = (alpha_right * right - alpha_left * left) / width
        by_omega[Y_LEFT], by_omega[Y_RIGHT] = -omega / width, omega / width
        by_omega[ALPHA_LEFT], by_omega[ALPHA_RIGHT] = -left / width, right / width
    else:
        omega = yaw_rate - bias
        by_omega[GYRO_BIAS] = -1.0
    middle = (y_left + y_right) / 2
    expected = np.array(
        [(alpha_left * left + alpha_right * right) / 2 + middle * omega, -x_icr * omega, omega]
    )
    jacobian = np.outer([middle, -x_icr, 1.0], by_omega)
    jacobian[0, Y_LEFT] += omega / 2
    jacobian[0, Y_RIGHT] += omega / 2
    jacobian[0, ALPHA_LEFT] += left / 2
    jacobian[0, ALPHA_RIGHT] += right / 2
    jacobian[1, X_ICR] -= omega
    measured = Measurement(velocity - expected, jacobian, covariance)
    return measured.part(np.isfinite(velocity))
