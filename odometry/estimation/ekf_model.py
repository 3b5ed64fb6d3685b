"""Model of motion and measurement for an extended Kalman filter."""

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np

from odometry.arrays import FloatArray, IntArray
from odometry.estimation.errors import EstimationError
from odometry.geometry.angles import wrap

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
        return np.flatnonzero(~np.isnan(z))


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
    """Values (..., n) with the entries `angles` in (-pi, pi]."""
    if not angles:
        return values
    values = np.array(values)
    values[..., angles] = wrap(values[..., angles])
    return values
