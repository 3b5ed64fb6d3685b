"""Bounds that the state of the filter never leaves."""

import math

import numpy as np

from odometry.arrays import FloatArray
from odometry.estimation.gaussian import project_into
from odometry.estimation.measurement import Gaussian
from odometry.estimation.transition import (
    ALPHA_LEFT,
    ALPHA_RIGHT,
    STATES,
    Y_LEFT,
    Y_RIGHT,
    YAW,
)
from odometry.geometry.angles import wrap_one

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
