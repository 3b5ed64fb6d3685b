"""The estimates of a bank of filters at one stamp."""

from dataclasses import dataclass

import numpy as np

from odometry.arrays import FloatArray
from odometry.estimation.errors import EstimationError
from odometry.estimation.mixture import log_sum

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
        if not (np.isfinite(self.means).all() and np.isfinite(self.covariances).all()):
            raise EstimationError(self._not_finite())
        logs = self.log_probabilities
        if np.isnan(logs).any() or not abs(log_sum(logs)) < SUM_TOLERANCE:
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
