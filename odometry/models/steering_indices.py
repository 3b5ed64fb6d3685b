"""Indices of sliding, eccentricity and steering efficiency (Martinez 2017 section III)."""

from dataclasses import dataclass

import numpy as np

from odometry.arrays import FloatArray
from odometry.models.inertia_columns import Column

LEAST_ETA = 0.1  # the tread ICRs stay at least a tenth of the track width apart


@dataclass(frozen=True)
class Indices:
    """The indices under a force of inertia; stacks (...).

    Attributes
    ----------
    force_n : (...)
        Magnitude of the force [N].
    x1_sign, x2_sign : (...)
        Signs of V_l - V_r and of V_l + H V_r (eq. 14-15).
    zeta, epsilon : (...)
        x_icr, and how far right the middle of the tread ICRs is [m].
    eta : (...)
        Distance between the tread ICRs in track widths.
    eta_is_free : (...)
        1, or 0 where eta is held at `LEAST_ETA`.
    """

    force_n: FloatArray
    x1_sign: FloatArray
    x2_sign: FloatArray
    zeta: FloatArray
    epsilon: FloatArray
    eta: FloatArray
    eta_is_free: FloatArray


def indices_under(
    coefficients: FloatArray, force_n: FloatArray, x1_sign: FloatArray, x2_sign: FloatArray
) -> Indices:
    """Martinez 2017 eq. 25-27 as printed, eta held at `LEAST_ETA` where it would fall below.

    Parameters
    ----------
    coefficients : (..., 7)
        zeta_0, zeta_1, epsilon_0, epsilon_1, eta_0, eta_1, eta_2.
    force_n, x1_sign, x2_sign : (...)
        See `Indices`.
    """
    zeta_0, zeta_1, epsilon_0, epsilon_1, eta_0, eta_1, eta_2 = np.moveaxis(coefficients, -1, 0)
    both = x1_sign * x2_sign
    eta = eta_0 + eta_1 * force_n * both + eta_2 * force_n**2  # eq. 27
    return Indices(
        force_n,
        x1_sign,
        x2_sign,
        zeta_0 + zeta_1 * force_n * x2_sign,  # eq. 25
        epsilon_0 + epsilon_1 * force_n * both,  # eq. 26
        np.maximum(eta, LEAST_ETA),
        np.where(eta > LEAST_ETA, 1.0, 0.0),
    )


def by_force(coefficients: FloatArray, at: Indices) -> FloatArray:
    """Derivative (..., 3) of zeta, epsilon, eta by the force."""
    _, zeta_1, _, epsilon_1, _, eta_1, eta_2 = np.moveaxis(coefficients, -1, 0)
    both = at.x1_sign * at.x2_sign
    by_eta = at.eta_is_free * (eta_1 * both + 2 * eta_2 * at.force_n)
    return np.stack(np.broadcast_arrays(zeta_1 * at.x2_sign, epsilon_1 * both, by_eta), axis=-1)


def by_coefficient(at: Indices) -> FloatArray:
    """Derivative (..., 3, 7) of zeta, epsilon, eta by the coefficients."""
    signed = at.x1_sign * at.x2_sign * at.force_n
    jacobian = np.zeros((*np.shape(at.eta), 3, Column.H))
    jacobian[..., 0, Column.ZETA_0] = 1
    jacobian[..., 0, Column.ZETA_1] = at.x2_sign * at.force_n
    jacobian[..., 1, Column.EPSILON_0] = 1
    jacobian[..., 1, Column.EPSILON_1] = signed
    jacobian[..., 2, Column.ETA_0] = at.eta_is_free
    jacobian[..., 2, Column.ETA_1] = at.eta_is_free * signed
    jacobian[..., 2, Column.ETA_2] = at.eta_is_free * at.force_n**2
    return jacobian
