"""The extended Kalman filters of all modes at once, in array operations."""

from dataclasses import dataclass

import numpy as np

from odometry.arrays import FloatArray
from odometry.estimation.ekf_model import EkfModel, log_density, wrapped


@dataclass(frozen=True)
class EkfBank:
    """What `Members` of `EkfMember` answer, without a loop over modes.

    Attributes
    ----------
    model : EkfModel
        Of all modes: its functions take states (M, n) and give one result for each.
    modes : int
    """

    model: EkfModel
    modes: int

    def predicted(
        self, means: FloatArray, covariances: FloatArray, u: FloatArray, step_s: float
    ) -> tuple[FloatArray, FloatArray]:
        """Means (M, n) and covariances (M, n, n) a step later."""
        self.model.check_states(means)
        F = self.model.transition_jacobian(means, u, step_s)
        predicted = F @ covariances @ _transposed(F) + self.model.process_noise(means, u, step_s)
        reached = wrapped(self.model.transition(means, u, step_s), self.model.state_angles)
        return reached, _symmetric(predicted)

    def updated(
        self, means: FloatArray, covariances: FloatArray, z: FloatArray
    ) -> tuple[FloatArray, FloatArray, FloatArray, FloatArray]:
        """Means, covariances, log-likelihoods (M,), normalised innovations squared (M,)."""
        entries = self.model.measured_entries(z)
        R = self.model.measurement_covariance[..., entries[:, None], entries]
        H = self.model.measurement_jacobian(means)[..., entries, :]
        residuals = wrapped(z - self.model.measurement(means), self.model.measurement_angles)[
            :, entries
        ]
        S = H @ covariances @ _transposed(H) + R
        inverse = np.linalg.inv(S)
        K = covariances @ _transposed(H) @ inverse
        squared = np.einsum("ja,jab,jb->j", residuals, inverse, residuals)
        corrected = means + (K @ residuals[..., None])[..., 0]
        remaining = np.eye(means.shape[1]) - K @ H
        joseph = remaining @ covariances @ _transposed(remaining) + K @ R @ _transposed(K)
        return (
            wrapped(corrected, self.model.state_angles),
            _symmetric(joseph),
            log_density(squared, S),
            squared,
        )

    def innovations(self, means: FloatArray, covariances: FloatArray, z: FloatArray) -> FloatArray:
        """Of predictions, each entry (M, m) in its own standard deviation; NaN: not measured."""
        H = self.model.measurement_jacobian(means)
        S = H @ covariances @ _transposed(H) + self.model.measurement_covariance
        residuals = wrapped(z - self.model.measurement(means), self.model.measurement_angles)
        return np.asarray(residuals / np.sqrt(np.diagonal(S, axis1=-2, axis2=-1)))


def _transposed(matrices: FloatArray) -> FloatArray:
    return matrices.swapaxes(-1, -2)


def _symmetric(matrices: FloatArray) -> FloatArray:
    return np.asarray((matrices + _transposed(matrices)) / 2)
