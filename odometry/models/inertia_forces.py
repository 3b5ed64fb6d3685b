"""Forces that depend on motion that depends on them, and indices of steering (Martinez 2017)."""

from collections.abc import Callable
from dataclasses import dataclass
from enum import IntEnum

import numpy as np

from odometry.arrays import FloatArray, IntArray, components_first
from odometry.models.base import vectors


class Column(IntEnum):
    """Place of a parameter; a derivative has the tread speeds after the parameters."""

    ZETA_0 = 0
    ZETA_1 = 1
    EPSILON_0 = 2
    EPSILON_1 = 3
    ETA_0 = 4
    ETA_1 = 5
    ETA_2 = 6
    H = 7
    MASS = 8
    X_CM = 9
    Y_CM = 10
    TRACK_WIDTH = 11
    V_LEFT = 12
    V_RIGHT = 13


COEFFICIENTS = slice(Column.ZETA_0, Column.H)
CENTRE_OF_MASS = slice(Column.X_CM, Column.TRACK_WIDTH)
PARAMETERS, SPEEDS = slice(0, Column.V_LEFT), slice(Column.V_LEFT, len(Column))


NEWTON_STEPS = 20
HALVINGS = 60  # from the limit down to its last digit
TOLERANCE = 4 * np.finfo(float).eps  # of the limit

ForceAt = Callable[[FloatArray], tuple[FloatArray, FloatArray]]


def consistent_force(
    force_at: ForceAt,
    limit_n: FloatArray,
    of_some: Callable[[IntArray], ForceAt] | None = None,
) -> FloatArray:
    """Force (...) with force = min(force_at(force), limit), by Newton's method within a bracket.

    Between 0 and the limit there is always such a force. Newton's method starts from no force;
    a step out of the bracket is replaced by its middle, and so are all steps after the
    twentieth. Where several forces are consistent (only if the force feeds back on itself more
    than one to one), the answer is one of them, for one sample always the same.

    Parameters
    ----------
    force_at : callable
        From a force (...) [N], not negative, to (...) the force that the motion under it would
        cause, not negative, and its derivative.
    limit_n : (...)
        [N]
    of_some : callable, optional
        From numbers of samples, of a stack (N,), to `force_at` of these: what has settled is then
        not computed again.
    """
    answer = np.empty_like(limit_n)
    left = np.arange(answer.size)
    low, high = np.zeros_like(limit_n), np.array(limit_n)
    force = low
    for step in range(NEWTON_STEPS + HALVINGS):
        caused, slope = force_at(force)
        excess = np.minimum(caused, limit_n) - force
        open_ = np.abs(excess) > TOLERANCE * limit_n
        if not np.any(open_):
            break
        low, high = np.where(excess > 0, force, low), np.where(excess > 0, high, force)
        proposed = (low + high) / 2
        if step < NEWTON_STEPS:
            slope = np.where(caused < limit_n, slope, 0.0)
            ahead = force + excess / np.where(slope < 1, 1 - slope, np.inf)
            proposed = np.where((slope < 1) & (ahead > low) & (ahead <= high), ahead, proposed)
        force = np.where(open_, proposed, force)
        if of_some is not None and 2 * np.count_nonzero(open_) < len(open_):
            answer[left] = force  # what is settled stays
            left, force_at = left[open_], of_some(left[open_])
            low, high, force, limit_n = (of[open_] for of in (low, high, force, limit_n))
    if of_some is None:
        return force
    answer[left] = force
    return answer


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
    zeta_0, zeta_1, epsilon_0, epsilon_1, eta_0, eta_1, eta_2 = components_first(coefficients)
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
    _, zeta_1, _, epsilon_1, _, eta_1, eta_2 = components_first(coefficients)
    both = at.x1_sign * at.x2_sign
    by_eta = at.eta_is_free * (eta_1 * both + 2 * eta_2 * at.force_n)
    return vectors(zeta_1 * at.x2_sign, epsilon_1 * both, by_eta)


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
