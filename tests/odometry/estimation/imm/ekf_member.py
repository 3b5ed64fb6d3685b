"""filterpy's extended Kalman filter as a member of a bank."""

import numpy as np
from filterpy.kalman import ExtendedKalmanFilter

from odometry.arrays import FloatArray
from odometry.estimation.imm.ekf_bank import EkfModel, log_density, wrapped


class EkfMember(ExtendedKalmanFilter):  # type: ignore[misc]
    """filterpy's filter with a model's transition in place of F x.

    Parameters
    ----------
    model : EkfModel
    """

    def __init__(self, model: EkfModel) -> None:
        super().__init__(dim_x=model.states, dim_z=len(model.measurement_covariance))
        self.model = model

    def predict_x(self, u: FloatArray) -> None:
        """Take `u`, the mean that the transition has reached: filterpy's hook."""
        self.x = u

    def predicted(
        self, mean: FloatArray, covariance: FloatArray, u: FloatArray, step_s: float
    ) -> tuple[FloatArray, FloatArray]:
        """Mean (n,) and covariance (n, n) a step later."""
        self.model.check_states(mean)
        self.x, self.P = mean, covariance
        self.F = self.model.transition_jacobian(mean, u, step_s)
        self.Q = self.model.process_noise(mean, u, step_s)
        self.predict(wrapped(self.model.transition(mean, u, step_s), self.model.state_angles))
        return self.x, (self.P + self.P.T) / 2

    def updated(
        self, mean: FloatArray, covariance: FloatArray, z: FloatArray
    ) -> tuple[FloatArray, FloatArray, float, float]:
        """Mean, covariance, log-likelihood, normalised innovation squared of what was measured."""
        entries = self.model.measured_entries(z)
        self.x, self.P = mean, covariance
        self.update(
            z,
            lambda x: self.model.measurement_jacobian(x)[entries],
            self.model.measurement,
            R=self.model.measurement_covariance[np.ix_(entries, entries)],
            residual=lambda measured, expected: wrapped(
                measured - expected, self.model.measurement_angles
            )[entries],
        )
        squared = float(self.y @ self.SI @ self.y)
        log_likelihood = float(log_density(squared, self.S))
        mean = wrapped(self.x, self.model.state_angles)
        return mean, (self.P + self.P.T) / 2, log_likelihood, squared
