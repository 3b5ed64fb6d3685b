"""Symmetric models: ideal differential drive, and one slip and one width for both treads."""

import numpy as np

from odometry.arrays import FloatArray
from odometry.models.base import KinematicModel, Parameter


class DifferentialDrive(KinematicModel):
    """No slip at all (Baril 2020 eq. 3)."""

    name = "differential_drive"
    source = "Baril 2020, eq. 3"
    parameters = (Parameter("track_width", "m", 1e-3),)

    def twist(self, values: FloatArray, tread_speeds: FloatArray) -> FloatArray:
        """See `KinematicModel.twist`."""
        return _symmetric_twist(np.ones_like(values[..., 0]), values[..., 0], tread_speeds)

    def parameter_jacobian(self, values: FloatArray, tread_speeds: FloatArray) -> FloatArray:
        """See `KinematicModel.parameter_jacobian`."""
        omega = self.twist(values, tread_speeds)[..., 2]
        zero = np.zeros_like(omega)
        return np.stack([zero, zero, -omega / values[..., 0]], axis=-1)[..., None]

    def speed_jacobian(self, values: FloatArray, tread_speeds: FloatArray) -> FloatArray:
        """See `KinematicModel.speed_jacobian`."""
        return _speed_matrix(np.ones_like(values[..., 0]), values[..., 0], tread_speeds)


class IcrSymmetric(KinematicModel):
    """One slip factor and one effective width (Baril 2020 eq. 8-9)."""

    name = "icr_symmetric"
    source = "Baril 2020, eq. 8-9"
    parameters = (Parameter("alpha", "", 0.0, 2.0), Parameter("b_hat", "m", 1e-3))

    def twist(self, values: FloatArray, tread_speeds: FloatArray) -> FloatArray:
        """See `KinematicModel.twist`."""
        return _symmetric_twist(values[..., 0], values[..., 1], tread_speeds)

    def parameter_jacobian(self, values: FloatArray, tread_speeds: FloatArray) -> FloatArray:
        """See `KinematicModel.parameter_jacobian`."""
        width = values[..., 1]
        by_alpha = _symmetric_twist(np.ones_like(width), width, tread_speeds)
        omega = self.twist(values, tread_speeds)[..., 2]
        zero = np.zeros_like(omega)
        by_width = np.stack([zero, zero, -omega / width], axis=-1)
        return np.stack([by_alpha, by_width], axis=-1)

    def speed_jacobian(self, values: FloatArray, tread_speeds: FloatArray) -> FloatArray:
        """See `KinematicModel.speed_jacobian`."""
        return _speed_matrix(values[..., 0], values[..., 1], tread_speeds)


def _symmetric_twist(alpha: FloatArray, width: FloatArray, tread_speeds: FloatArray) -> FloatArray:
    left, right = np.moveaxis(np.asarray(tread_speeds), -1, 0)
    v_x = alpha * (left + right) / 2
    return np.stack([v_x, np.zeros_like(v_x), alpha * (right - left) / width], axis=-1)


def _speed_matrix(alpha: FloatArray, width: FloatArray, tread_speeds: FloatArray) -> FloatArray:
    half, turn = alpha / 2, alpha / width
    zero = np.zeros_like(half)
    rows = [
        np.stack([half, half], axis=-1),
        np.stack([zero, zero], axis=-1),
        np.stack([-turn, turn], axis=-1),
    ]
    stack = np.broadcast_shapes(np.shape(half), np.shape(tread_speeds)[:-1])
    return np.broadcast_to(np.stack(rows, axis=-2), (*stack, 3, 2))
