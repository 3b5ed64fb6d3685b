"""What noise explains of stretches of positions: positions measured with error, and wander.

Three variances make the covariance of a stretch: of a measured position, and of what a metre of
wheel travel adds to the place and to the yaw. The direction in which a stretch starts is not
measured: what lies along it is no evidence, and is taken out.
"""

from dataclasses import dataclass

import numpy as np

from odometry.arrays import FloatArray
from odometry.windows.stretches.stretches import Stretches

FIRST_GUESS = np.square([0.1, 0.02, 0.02])
SMALLEST = np.square([1e-4, 1e-5, 1e-5])
BIAS_RAD_S = 0.005  # of a gyroscope, whose mean over the run was taken out
TURN_RAD = 1e-3  # of a turn that a gyroscope measures
ROUNDS = 10
FARTHEST = 20.0  # times a variance, to which one round may raise or lower it


@dataclass(frozen=True)
class StretchNoise:
    """Variances of stretches.

    Attributes
    ----------
    variances : (3,)
        Of a position [m^2], of the place and of the yaw per metre of wheel travel [m, rad^2/m].
    precision : (3, 3)
        Fisher information of these.
    """

    variances: FloatArray
    precision: FloatArray

    @property
    def position_m(self) -> float:
        """Standard deviation of a measured position."""
        return float(np.sqrt(self.variances[0]))

    @property
    def wander_rad(self) -> float:
        """Standard deviation of the yaw that a metre of wheel travel adds."""
        return float(np.sqrt(self.variances[2]))


UNKNOWN_NOISE = StretchNoise(FIRST_GUESS, np.zeros((3, 3)))


def covariance_parts(of: Stretches) -> FloatArray:
    """Derivative (3, K, R, R) of the covariance of the residuals by each variance."""
    count, steps, _ = of.measured.shape
    j = np.arange(steps)
    position, wander = np.zeros((2, count, steps, 2, steps, 2))
    summed_m = np.cumsum(of.steps_m, axis=1)[:, np.minimum(j[:, None], j[None, :])]
    for axis in (0, 1):
        position[:, :, axis, :, axis] = np.ones((steps, steps)) + np.eye(steps)
        wander[:, :, axis, :, axis] = summed_m
    size = (count, 2 * steps, 2 * steps)
    position, wander = position.reshape(size), wander.reshape(size)
    if of.turns_rad is None:
        swing = _swing(of, np.sqrt(of.steps_m))
        return np.stack([position, wander, swing.swapaxes(1, 2) @ swing])
    parts = np.zeros((3, count, 3 * steps, 3 * steps))
    parts[0, :, : 2 * steps, : 2 * steps] = position
    parts[1, :, : 2 * steps, : 2 * steps] = wander
    parts[2, :, 2 * steps :, 2 * steps :] = summed_m
    return parts


def known_covariance(of: Stretches) -> FloatArray:
    """Covariance (K, R, R) of the residuals that a gyroscope's bias makes; zero without one."""
    count, steps, _ = of.measured.shape
    if of.turns_rad is None:
        return np.zeros((count, 2 * steps, 2 * steps))
    steps_s = np.diff(of.lasts_s, axis=1, prepend=0.0)
    swung = BIAS_RAD_S * _swing(of, steps_s).sum(axis=1)
    causes = np.concatenate([swung, BIAS_RAD_S * of.lasts_s], axis=1)
    floor = np.zeros((3 * steps, 3 * steps))
    floor[2 * steps :, 2 * steps :] = TURN_RAD**2 * np.eye(steps)
    return np.asarray(causes[:, :, None] * causes[:, None, :] + floor)


def _swing(of: Stretches, turns: FloatArray) -> FloatArray:
    """What turns (K, n) on the way to each position add to the ways: (K, n, 2n)."""
    count, steps, _ = of.measured.shape
    j = np.arange(steps)
    before = np.concatenate([np.zeros((count, 1, 2)), of.measured[:, :-1]], axis=1)
    beyond = of.measured[:, None, :, :] - before[:, :, None, :]  # (K, i, j, 2) from i on
    swing = np.stack([-beyond[..., 1], beyond[..., 0]], axis=-1)
    swing *= (j[None, :] >= j[:, None])[None, :, :, None] * turns[:, :, None, None]
    return swing.reshape(count, steps, 2 * steps)


def whitening(
    of: Stretches, variances: FloatArray, parts: FloatArray, known: FloatArray
) -> FloatArray:
    """Matrices (K, R, R) that make residuals white, and blind to a turn of the whole stretch."""
    covariance = np.einsum("p,pkij->kij", variances, parts) + known
    root = np.linalg.inv(np.linalg.cholesky(covariance))
    turned = np.stack([-of.measured[..., 1], of.measured[..., 0]], axis=-1).reshape(len(of), -1)
    unseen = np.einsum("kij,kj->ki", root[:, :, : turned.shape[1]], turned)
    size = np.maximum(np.linalg.norm(unseen, axis=1, keepdims=True), np.finfo(float).tiny)
    unseen = unseen / size
    return np.asarray(root - unseen[:, :, None] * np.einsum("ki,kij->kj", unseen, root)[:, None, :])


def likeliest_noise(
    of: Stretches, residuals: FloatArray, jacobian: FloatArray, weights: FloatArray
) -> StretchNoise:
    """Most likely variances, by Fisher scoring of the restricted likelihood.

    Restricted: what the parameters and the direction of each stretch follow is taken out
    (Patterson and Thompson 1971).

    Parameters
    ----------
    of : Stretches
    residuals : (K, 2n)
    jacobian : (K, 2n, F)
        Their derivative by the parameters, in comparable units.
    weights : (K,)
        Of the stretches.
    """
    parts, known = covariance_parts(of), known_covariance(of)
    variances = FIRST_GUESS.copy()
    for _ in range(ROUNDS):
        white = whitening(of, variances, parts, known)
        inner = np.einsum("kij,pkjl,kml->pkim", white, parts, white, optimize=True)
        found = np.einsum("kij,kj->ki", white, residuals) * np.sqrt(weights)[:, None]
        by = white @ jacobian
        curvature = np.einsum("k,kif,kig->fg", weights, by, by)
        followed = np.einsum("k,kif,pkij,kjg->pfg", weights, by, inner, by, optimize=True)
        shares = np.einsum("fg,pgf->p", np.linalg.pinv(curvature, hermitian=True), followed)
        traces = np.einsum("k,pkii->p", weights, inner) - shares
        squares = np.einsum("ki,pkij,kj->p", found, inner, found, optimize=True)
        information = np.einsum("k,pkij,qkji->pq", weights, inner, inner, optimize=True) / 2
        step = np.linalg.lstsq(information, (squares - traces) / 2, rcond=None)[0]
        variances = np.clip(
            variances + step, np.maximum(SMALLEST, variances / FARTHEST), FARTHEST * variances
        )
    return StretchNoise(variances, information)
