"""Mixtures of Gaussians: their moments, with angles on the circle, and weights as logarithms."""

import numpy as np

from odometry.arrays import FloatArray
from odometry.geometry.angles import wrap

NO_DIRECTION = 1e-12  # a mean direction vector this short points nowhere


def moments(
    weights: FloatArray, means: FloatArray, covariances: FloatArray, angles: tuple[int, ...] = ()
) -> tuple[FloatArray, FloatArray]:
    """Mean and covariance of K mixtures of the same M Gaussians.

    Parameters
    ----------
    weights : (K, M)
        Rows sum to 1.
    means, covariances : (M, n), (M, n, n)
    angles : tuple of int
        Entries of the state that are angles [rad].

    Returns
    -------
    means, covariances : (K, n), (K, n, n)
        Salvi 2024 eq. 6-7 and 10-11. The mean of angles is the direction of the weighted mean of
        their unit vectors; where these cancel, the angle of the heaviest. Deviations of angles
        are wrapped.
    """
    modes, size = means.shape
    mixed = weights @ means
    if angles:
        mixed[:, angles] = _mean_angles(weights, means[:, angles])
    deviations = means - mixed[:, None, :]  # (K, M, n)
    if angles:
        deviations[..., angles] = wrap(deviations[..., angles])
    within = (weights @ covariances.reshape(modes, size * size)).reshape(-1, size, size)
    between = (deviations * weights[..., None]).swapaxes(1, 2) @ deviations
    return mixed, within + (between + between.swapaxes(1, 2)) / 2


def _mean_angles(weights: FloatArray, angles: FloatArray) -> FloatArray:
    """Mean directions (K, a) of angles (M, a), taken from the heaviest so that equals stay so."""
    heaviest = angles[weights.argmax(axis=1)]
    turned = angles - heaviest[:, None, :]  # (K, M, a)
    sine, cosine = ((weights[:, None, :] @ part)[:, 0] for part in (np.sin(turned), np.cos(turned)))
    turn = np.where(np.hypot(sine, cosine) > NO_DIRECTION, np.arctan2(sine, cosine), 0.0)
    return wrap(heaviest + turn)


def log_sum(logs: FloatArray) -> FloatArray:
    """Logarithm of the sum of exponentials over the first axis; minus infinity is a zero."""
    return np.asarray(np.logaddexp.reduce(logs, axis=0))


def floored(log_weights: FloatArray, floor: float) -> FloatArray:
    """Log-probabilities (M,) in proportion to `log_weights`, none below `floor`.

    Those that would fall below are set to it; the others keep their proportions in what is left,
    so that the floor holds after the sum is 1 again. A floor of 0 only normalises.
    """
    log_probabilities = log_weights - log_sum(log_weights)
    if floor == 0 or log_probabilities.min() >= np.log(floor):
        return np.asarray(log_probabilities)
    probabilities = np.exp(log_probabilities)
    low = probabilities < floor
    while True:
        scale = (1 - floor * low.sum()) / probabilities[~low].sum()
        fallen = ~low & (probabilities * scale < floor)
        if not fallen.any():
            return np.asarray(np.where(low, np.log(floor), log_probabilities + np.log(scale)))
        low |= fallen
