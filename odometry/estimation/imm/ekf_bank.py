"""Extended Kalman filters of all modes at once: their models, and steps in array operations."""

import math
from collections.abc import Callable
from dataclasses import dataclass
from functools import lru_cache

import numpy as np

from odometry.arrays import FloatArray, IntArray
from odometry.errors import EstimationError
from odometry.geometry.angles import entries, wrap

Motion = Callable[[FloatArray, FloatArray, float], FloatArray]
Measurement = Callable[[FloatArray], FloatArray]


@dataclass(frozen=True)
class EkfModel:
    """Functions of the state x (n,), the input u and the step dt [s] (Salvi 2024 eq. 1).

    For a bank (`EkfBank`) the functions take states (M, n), one of each mode, and their results
    have the modes in front; a Jacobian or a covariance may leave them out where all modes share it.

    Attributes
    ----------
    states : int
        The number n.
    transition, transition_jacobian, process_noise : function of (x, u, dt)
        The state a step later (n,), its derivative by the state (n, n), the covariance that the
        step adds (n, n), at the state before it.
    measurement, measurement_jacobian : function of x
        What would be measured (m,), its derivative (m, n).
    measurement_covariance : (m, m)
        Of a bank also (M, m, m).
    state_angles, measurement_angles : tuple of int
        Entries that are angles [rad]: the state's are kept in (-pi, pi], residuals are wrapped.

    Raises
    ------
    EstimationError
        If the measurement covariance is not positive definite, or an angle is not an
        entry.
    """

    states: int
    transition: Motion
    transition_jacobian: Motion
    process_noise: Motion
    measurement: Measurement
    measurement_jacobian: Measurement
    measurement_covariance: FloatArray
    state_angles: tuple[int, ...] = ()
    measurement_angles: tuple[int, ...] = ()

    def __post_init__(self) -> None:
        shape = np.shape(self.measurement_covariance)
        if len(shape) < 2 or shape[-1] != shape[-2]:
            raise EstimationError(f"measurement covariance of shape {shape}, expected square")
        try:
            np.linalg.cholesky(self.measurement_covariance)
        except np.linalg.LinAlgError as error:
            raise EstimationError(
                f"measurement covariance {np.asarray(self.measurement_covariance).tolist()}, "
                "expected positive definite"
            ) from error
        for what, angles, size in (
            ("state", self.state_angles, self.states),
            ("measurement", self.measurement_angles, shape[-1]),
        ):
            if any(not 0 <= angle < size for angle in angles):
                raise EstimationError(f"{what} angles {angles}, expected below {size}, its entries")

    def check_states(self, means: FloatArray) -> None:
        """Raise EstimationError if means (..., n) are not of this model's states."""
        if means.shape[-1] != self.states:
            raise EstimationError(f"{means.shape[-1]} states, expected {self.states}")

    def measured_entries(self, z: FloatArray) -> IntArray:
        """Places of the entries of a measurement (m,) that are not NaN.

        Raises
        ------
        EstimationError
            If the measurement has another shape.
        """
        size = np.shape(self.measurement_covariance)[-1]
        if np.shape(z) != (size,):
            raise EstimationError(f"a measurement of shape {np.shape(z)}, expected ({size},)")
        return np.array([i for i, number in enumerate(z.tolist()) if not math.isnan(number)], int)


def log_density(normalised_squared: FloatArray | float, covariance: FloatArray) -> FloatArray:
    """Logarithm of Salvi 2024 eq. 8, from squared Mahalanobis lengths (...) of residuals.

    Parameters
    ----------
    normalised_squared : (...)
    covariance : (..., m, m)
        Of the residuals.
    """
    log_determinant = np.linalg.slogdet(covariance).logabsdet
    scale = covariance.shape[-1] * np.log(2 * np.pi)
    return np.asarray(-(normalised_squared + log_determinant + scale) / 2)


def wrapped(values: FloatArray, angles: tuple[int, ...]) -> FloatArray:
    """Values (..., n) with the entries `angles` in (-pi, pi]; the same where they are."""
    part = entries(angles)
    of_angles = values[..., part]
    if all(-math.pi < angle <= math.pi for angle in of_angles.ravel().tolist()):
        return values
    values = np.array(values)
    values[..., part] = wrap(of_angles)
    return values


@dataclass(frozen=True)
class EkfBank:
    """What `Members` of `EkfMember` answer, without a loop over modes.

    Attributes
    ----------
    model : EkfModel
        Of all modes: its functions take states (M, n) and give one result for each. Where they
        take those of several estimates at once, (..., M, n), so does the bank.
    modes : int
    """

    model: EkfModel
    modes: int

    def predicted(
        self, means: FloatArray, covariances: FloatArray, u: FloatArray, step_s: float
    ) -> tuple[FloatArray, FloatArray]:
        """Means (..., M, n) and covariances (..., M, n, n) a step later."""
        self.model.check_states(means)
        F = self.model.transition_jacobian(means, u, step_s)
        predicted = F @ covariances @ _transposed(F) + self.model.process_noise(means, u, step_s)
        reached = wrapped(self.model.transition(means, u, step_s), self.model.state_angles)
        return reached, _symmetric(predicted)

    def updated(
        self, means: FloatArray, covariances: FloatArray, z: FloatArray
    ) -> tuple[FloatArray, FloatArray, FloatArray, FloatArray]:
        """Means, covariances, log-likelihoods (..., M), normalised innovations squared (..., M)."""
        seen = self.model.measured_entries(z)
        R, H = self.model.measurement_covariance, self.model.measurement_jacobian(means)
        residuals = wrapped(z - self.model.measurement(means), self.model.measurement_angles)
        if len(seen) < len(z):
            R, H, residuals = R[..., seen[:, None], seen], H[..., seen, :], residuals[..., seen]
        H_transposed = _transposed(H)
        S = H @ covariances @ H_transposed + R
        inverse = np.linalg.inv(S)
        K = covariances @ H_transposed @ inverse
        squared = (residuals[..., None, :] @ inverse @ residuals[..., None])[..., 0, 0]
        corrected = means + (K @ residuals[..., None])[..., 0]
        remaining = _unit(means.shape[-1]) - K @ H
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


@lru_cache(maxsize=16)
def _unit(size: int) -> FloatArray:
    return np.eye(size)


def _transposed(matrices: FloatArray) -> FloatArray:
    return matrices.swapaxes(-1, -2)


def _symmetric(matrices: FloatArray) -> FloatArray:
    return np.asarray((matrices + _transposed(matrices)) / 2)
