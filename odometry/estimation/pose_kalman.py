"""filterpy's extended Kalman filter for the state of `odometry.estimation.transition`."""

import numpy as np
from filterpy.kalman import ExtendedKalmanFilter

from odometry.arrays import FloatArray
from odometry.estimation.measurement import Measurement
from odometry.estimation.transition import STATES


class PoseKalman(ExtendedKalmanFilter):  # type: ignore[misc]
    """filterpy's filter with the exact transition in place of F x.

    One of these serves one measurement size: filterpy keeps arrays of it.
    """

    def __init__(self) -> None:
        super().__init__(dim_x=STATES, dim_z=3)
        self.Q = np.zeros((STATES, STATES))
        self._added = self.Q.reshape(-1)[:: STATES + 1]  # the diagonal of Q
        self.weighed = np.zeros(3)  # inverse of S times the last innovation

    def predict_x(self, u: FloatArray) -> None:
        """Take `u`, the mean that `transition` has reached: filterpy's hook."""
        self.x = u

    def predicted(
        self,
        mean: FloatArray,
        jacobian: FloatArray,
        covariance: FloatArray,
        noise: FloatArray,
    ) -> FloatArray:
        """Covariance (9, 9) at the end of a step: Chen 2023 eq. 7.

        Parameters
        ----------
        mean : (9,)
            At the end.
        jacobian : (9, 9)
            Of the step.
        covariance : (9, 9)
            At its beginning.
        noise : (9,)
            Variance that white noise adds to each state over the step.

        Notes
        -----
        Half of the noise goes in before the step and half after it: the trapezium rule for the
        integral of F(s) Q F(s)^T. The first step of eq. 7 would make the answer depend on how
        finely time is cut.
        """
        np.multiply(noise, 0.5, out=self._added)
        self.P = covariance + self.Q
        self.F = jacobian
        self.predict(mean)
        return np.asarray(self.P)

    def updated(
        self, mean: FloatArray, covariance: FloatArray, measured: Measurement
    ) -> tuple[FloatArray, FloatArray, float]:
        """Mean (9,), covariance (9, 9), normalised innovation squared: eq. 14-15, Joseph's 16."""
        self.x, self.P = mean, covariance
        self.update(
            measured.residual, _derivative, _nothing, measured.covariance, (measured.jacobian,)
        )
        self.weighed = self.SI.dot(self.y)
        return self.x, (self.P + self.P.T) * 0.5, float(self.y.dot(self.weighed))


def _derivative(_: FloatArray, jacobian: FloatArray) -> FloatArray:
    """The derivative of a measurement, which its residual came with: filterpy's HJacobian."""
    return jacobian


def _nothing(_: FloatArray) -> float:
    """What is taken from a residual, which is measured less expected already: filterpy's Hx."""
    return 0.0
