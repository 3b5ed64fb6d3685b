"""The estimates of a bank of filters at one stamp, and mixtures of Gaussians."""

import math
from dataclasses import dataclass

import numpy as np

from odometry.arrays import FloatArray
from odometry.errors import EstimationError
from odometry.geometry.angles import entries, wrap

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
    part = entries(angles)
    if angles:
        mixed[:, part] = _mean_angles(weights, means[:, part])
    deviations = means - mixed[:, None, :]  # (K, M, n)
    if angles and not _are_near(means[:, part]):
        mixed[:, part] = wrap(mixed[:, part])
        deviations[..., part] = wrap(deviations[..., part])
    within = (weights @ covariances.reshape(modes, size * size)).reshape(-1, size, size)
    between = (deviations * weights[..., None]).swapaxes(1, 2) @ deviations
    return mixed, within + (between + between.swapaxes(1, 2)) / 2


def _mean_angles(weights: FloatArray, angles: FloatArray) -> FloatArray:
    """Mean directions (K, a) of angles (M, a), taken from the heaviest so that equals stay so.

    Not wrapped; they lie between the angles where these span less than half a turn.
    """
    heaviest = angles[weights.argmax(axis=1)]
    turned = angles - heaviest[:, None, :]  # (K, M, a)
    sine, cosine = ((weights[:, None, :] @ part)[:, 0] for part in (np.sin(turned), np.cos(turned)))
    turn = np.arctan2(sine, cosine)
    if cosine.min() <= NO_DIRECTION:
        turn = np.where(np.hypot(sine, cosine) > NO_DIRECTION, turn, 0.0)
    return np.asarray(heaviest + turn)


def _are_near(angles: FloatArray) -> bool:
    """Whether each column of angles (M, a) spans less than half a turn, within (-pi, pi]."""
    ends = [(min(of), max(of)) for of in angles.T.tolist()]
    return all(-math.pi < low <= high <= math.pi and high - low < math.pi for low, high in ends)


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


SUM_TOLERANCE = 1e-9


@dataclass(frozen=True)
class ModeInnovations:
    """A measurement compared with the prediction of each mode.

    Attributes
    ----------
    log_likelihoods : (M,)
    normalised_squared : (M,)
        Squared Mahalanobis length of each mode's residual.
    """

    log_likelihoods: FloatArray
    normalised_squared: FloatArray


@dataclass(frozen=True)
class ModeBelief:
    """A Gaussian for each mode, and how probable each mode is.

    Attributes
    ----------
    means, covariances : (M, n), (M, n, n)
    log_probabilities : (M,)
        Natural logarithms; minus infinity where a mode is impossible.
    innovations : ModeInnovations or None
        None where nothing was measured at this stamp, and in a prediction.

    Raises
    ------
    EstimationError
        If shapes do not agree, the state is not finite or the probabilities do not sum to 1.
    """

    means: FloatArray
    covariances: FloatArray
    log_probabilities: FloatArray
    innovations: ModeInnovations | None = None

    def __post_init__(self) -> None:
        shapes = self.means.shape, self.covariances.shape, self.log_probabilities.shape
        if len(shapes[0]) != 2 or not self.means.size:
            raise EstimationError(f"means of shape {shapes[0]}, expected (modes, states)")
        modes, size = shapes[0]
        if shapes != ((modes, size), (modes, size, size), (modes,)):
            raise EstimationError(
                f"means, covariances and log-probabilities of shapes {shapes[0]}, {shapes[1]} and "
                f"{shapes[2]}, expected {(modes, size)}, {(modes, size, size)} and {(modes,)}"
            )
        if not (_are_finite(self.means) and _are_finite(self.covariances)):
            raise EstimationError(self._not_finite())
        logs = self.log_probabilities
        if any(map(math.isnan, logs.tolist())) or not abs(log_sum(logs)) < SUM_TOLERANCE:
            raise EstimationError(
                f"mode probabilities {self.probabilities.tolist()}, expected a sum of 1"
            )

    @classmethod
    def alike(
        cls, mean: FloatArray, covariance: FloatArray, probabilities: FloatArray
    ) -> "ModeBelief":
        """One Gaussian (n,), (n, n) for all modes of the given probabilities (M,)."""
        modes = len(probabilities)
        weights = np.asarray(probabilities, dtype=np.float64)
        logs = np.log(weights, out=np.full(modes, -np.inf), where=weights > 0)
        return cls(np.tile(mean, (modes, 1)), np.tile(covariance, (modes, 1, 1)), logs)

    @property
    def modes(self) -> int:
        """The number M of modes."""
        return len(self.means)

    @property
    def probabilities(self) -> FloatArray:
        """(M,), not logarithms."""
        return np.asarray(np.exp(self.log_probabilities))

    def _not_finite(self) -> str:
        for mode, (mean, covariance) in enumerate(zip(self.means, self.covariances, strict=True)):
            if not (np.isfinite(mean).all() and np.isfinite(covariance).all()):
                return (
                    f"mode {mode}: mean {mean.tolist()}, covariance {covariance.tolist()}, "
                    "expected finite numbers"
                )
        raise AssertionError


def _are_finite(values: FloatArray) -> bool:
    if math.isfinite(np.add.reduce(values, axis=None)):
        return True
    return bool(np.logical_and.reduce(np.isfinite(values), axis=None))
