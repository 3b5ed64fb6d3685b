"""filterpy's extended Kalman filter for the state (x, y, yaw, y_left, y_right, x_icr)."""

import numpy as np
from filterpy.kalman import ExtendedKalmanFilter

from odometry.arrays import FloatArray
from odometry.estimation.transition import process_noise, transition
from odometry.geometry.angles import wrap


class PoseKalman(ExtendedKalmanFilter):  # type: ignore[misc]
    """filterpy's filter with the exact transition in place of F x."""

    def __init__(self, measurement_covariance: FloatArray) -> None:
        super().__init__(dim_x=6, dim_z=3)
        self.R = measurement_covariance  # Chen 2023 eq. 14
        self.H = np.eye(3, 6)  # eq. 13

    def predict_x(self, u: FloatArray) -> None:
        """Take `u`, the mean that `transition` has reached: filterpy's hook."""
        self.x = u

    def predicted(
        self,
        mean: FloatArray,
        covariance: FloatArray,
        speeds: FloatArray,
        added_twist: FloatArray,
        *,
        step_s: float,
        density: FloatArray,
    ) -> tuple[FloatArray, FloatArray]:
        """Eq. 7 with the Jacobian of `transition`."""
        self.x, self.P = mean, covariance
        next_mean, self.F = transition(mean, speeds, step_s, added_twist)
        self.Q = process_noise(self.F, density, step_s)
        self.predict(next_mean)
        return self.x, self.P

    def updated(
        self, mean: FloatArray, covariance: FloatArray, pose: FloatArray
    ) -> tuple[FloatArray, FloatArray]:
        """Eq. 14-15; the covariance in Joseph's form instead of eq. 16."""
        self.x, self.P = mean, covariance
        self.update(pose, lambda _: self.H, lambda x: x[:3], residual=pose_residual)
        return self.x, (self.P + self.P.T) / 2


def pose_residual(measured: FloatArray, predicted: FloatArray) -> FloatArray:
    """Measured less predicted pose (3,), yaw in (-pi, pi]."""
    residual = measured - predicted
    residual[2] = wrap(residual[2])
    return residual
