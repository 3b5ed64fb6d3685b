"""Tread ICRs from a twist and tread speeds, and the indices that Martinez makes of them."""

from statistics import NormalDist

import numpy as np
from numpy.typing import ArrayLike

from odometry.arrays import BoolArray, FloatArray

NO_SLIP = (1.0, 1.0)


def icrs_of_twist(
    twists: FloatArray, tread_speeds_m_s: FloatArray, alphas: ArrayLike = NO_SLIP
) -> FloatArray:
    """The ICRs that both treads must have had for a robot to move so: `icr_twist` turned round.

    Baril 2020 eq. 4 to 6 with the sign and the place of alpha corrected, Chen 2023 eq. 2,
    Martinez 2017 eq. 1 to 3.

    Parameters
    ----------
    twists : (..., 3)
        v_x, v_y [m/s], omega [rad/s] in the robot frame.
    tread_speeds_m_s : (..., 2)
        v_left, v_right, before any slip.
    alphas : (..., 2)
        Slip factors of the left and the right tread.

    Returns
    -------
    (..., 3)
        y_left, y_right, x_icr [m]; NaN without any turn. `turn_is_known` says which points noise
        leaves a meaning.

    Examples
    --------
    >>> import numpy as np
    >>> import odometry
    >>> twist, treads = np.array([0.5, 0.1, 0.25]), np.array([0.4, 0.6])
    >>> odometry.icrs_of_twist(twist, treads).round(3).tolist()  # y_left, y_right, x_icr [m]
    [0.4, -0.4, -0.4]
    """
    v_x, v_y, omega = np.moveaxis(np.asarray(twists, dtype=np.float64), -1, 0)
    left, right = np.moveaxis(np.asarray(alphas) * np.asarray(tread_speeds_m_s), -1, 0)
    with np.errstate(divide="ignore", invalid="ignore", over="ignore"):
        icrs = np.stack(
            [
                (v_x - left) / omega,  # Baril 2020 eq. 5; Martinez 2017 eq. 1, y = -x
                (v_x - right) / omega,  # Baril 2020 eq. 6; Martinez 2017 eq. 2
                -v_y / omega,  # Baril 2020 eq. 4, first row; Martinez 2017 eq. 3
            ],
            axis=-1,
        )
    return np.where(np.isfinite(icrs).all(axis=-1, keepdims=True), icrs, np.nan)


def icr_covariances(
    twists: FloatArray,
    tread_speeds_m_s: FloatArray,
    twist_covariances: FloatArray,
    speed_variances: FloatArray,
    alphas: ArrayLike = NO_SLIP,
) -> FloatArray:
    """Covariance of `icrs_of_twist` by the noise of twists and speeds, to first order.

    First order holds where omega is several times its standard deviation: see `turn_is_known`.

    Parameters
    ----------
    twists, tread_speeds_m_s, alphas
        As of `icrs_of_twist`.
    twist_covariances : (..., 3, 3)
    speed_variances : (..., 2)
        Of v_left and v_right [m^2/s^2].

    Returns
    -------
    (..., 3, 3)
        Of y_left, y_right, x_icr [m^2]; NaN without any turn.

    Examples
    --------
    >>> import numpy as np
    >>> import odometry
    >>> twist, treads = np.array([0.5, 0.0, 0.5]), np.array([0.4, 0.6])
    >>> noise = np.diag([0.01, 0.01, 0.01]) ** 2
    >>> covariance = odometry.icr_covariances(twist, treads, noise, np.array([0.01, 0.01]) ** 2)
    >>> np.sqrt(np.diag(covariance)).round(3).tolist()  # of y_left, y_right, x_icr [m]
    [0.029, 0.029, 0.02]
    """
    icrs = icrs_of_twist(twists, tread_speeds_m_s, alphas)
    by_twist = np.zeros((*icrs.shape, 3))
    by_twist[..., :2, 0], by_twist[..., 2, 1] = 1.0, -1.0
    by_twist[..., :, 2] = -icrs
    effective = np.zeros(icrs.shape)
    effective[..., :2] = np.square(alphas) * speed_variances
    of_numerators = by_twist @ twist_covariances @ by_twist.swapaxes(-1, -2)
    of_numerators = of_numerators + effective[..., None] * np.eye(3)
    with np.errstate(divide="ignore", invalid="ignore", over="ignore"):
        return np.asarray(of_numerators / np.square(twists[..., 2, None, None]))


def turn_is_known(
    omega_rad_s: FloatArray, sigma_rad_s: FloatArray, probability: float
) -> BoolArray:
    """Whether a robot surely turned, and to which side: the sign of omega has this probability.

    Where it has not, the interval of an ICR at this probability has no ends (Fieller 1954): the
    point says nothing.

    Parameters
    ----------
    omega_rad_s, sigma_rad_s : (...)
        Measured yaw rates and their standard deviations.
    probability : float
        Above 0.5, below 1.

    Examples
    --------
    >>> import numpy as np
    >>> import odometry
    >>> omega_rad_s = np.array([0.5, 0.01])  # a turn, and nearly straight
    >>> odometry.turn_is_known(omega_rad_s, np.array([0.02, 0.02]), probability=0.95).tolist()
    [True, False]
    """
    least_sigmas = NormalDist().inv_cdf(probability)
    return np.asarray(np.abs(omega_rad_s) > least_sigmas * np.asarray(sigma_rad_s))


def icr_indices(icrs: FloatArray, track_width_m: float) -> FloatArray:
    """Indices of sliding, eccentricity and steering efficiency (Martinez 2017 eq. 17 to 19).

    Parameters
    ----------
    icrs : (..., 3)
        y_left, y_right, x_icr [m].
    track_width_m : float
        Between the middles of the treads (L).

    Returns
    -------
    (..., 3)
        zeta [m]: above 0 the robot heads into the curve; epsilon [m]: above 0 it turns to the
        right less easily than to the left; eta: 1 without slip, larger where turning is resisted.

    Examples
    --------
    >>> import numpy as np
    >>> import odometry
    >>> odometry.icr_indices(np.array([0.3, -0.4, 0.05]), 0.4).round(2).tolist()
    [0.05, 0.05, 1.75]
    """
    y_left, y_right, x_icr = np.moveaxis(np.asarray(icrs), -1, 0)
    zeta = x_icr  # eq. 17
    epsilon = -(y_left + y_right) / 2  # eq. 18, x = -y
    eta = (y_left - y_right) / track_width_m  # eq. 19
    return np.stack([zeta, epsilon, eta], axis=-1)
