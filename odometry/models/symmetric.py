"""Symmetric models: ideal differential drive, and one slip and one width for both treads."""

import numpy as np

from odometry.arrays import FloatArray
from odometry.models.base import Parameter
from odometry.models.icr import GUESSED_WIDTHS
from odometry.models.inputs import Inputs
from odometry.models.invertible import InvertibleModel, before_slip, icr_tread_speeds
from odometry.run import Robot


class DifferentialDrive(InvertibleModel):
    """No slip at all (Baril 2020 eq. 3)."""

    name = "differential_drive"
    source = "Baril 2020, eq. 3"
    parameters = (Parameter("track_width", "m", 1e-3, known=True),)

    def twist(self, values: FloatArray, inputs: Inputs) -> FloatArray:
        """See `KinematicModel.twist`."""
        return _symmetric_twist(np.ones_like(values[..., 0]), values[..., 0], inputs)

    def parameter_jacobian(self, values: FloatArray, inputs: Inputs) -> FloatArray:
        """See `KinematicModel.parameter_jacobian`."""
        omega = self.twist(values, inputs)[..., 2]
        zero = np.zeros_like(omega)
        return np.stack([zero, zero, -omega / values[..., 0]], axis=-1)[..., None]

    def speed_jacobian(self, values: FloatArray, inputs: Inputs) -> FloatArray:
        """See `KinematicModel.speed_jacobian`."""
        return _speed_matrix(np.ones_like(values[..., 0]), values[..., 0], inputs)

    def tread_speeds(self, values: FloatArray, v_x: FloatArray, omega: FloatArray) -> FloatArray:
        """See `InvertibleModel.tread_speeds`."""
        half = values[..., 0] / 2
        return icr_tread_speeds(half, -half, v_x, omega)

    def guess(self, robot: Robot) -> dict[str, float]:
        """The track width."""
        return {"track_width": robot.track_width}


class IcrSymmetric(InvertibleModel):
    """One slip factor and one effective width (Baril 2020 eq. 8-9)."""

    name = "icr_symmetric"
    source = "Baril 2020, eq. 8-9"
    parameters = (Parameter("alpha", "", 0.0, 2.0), Parameter("b_hat", "m", 1e-3))

    def twist(self, values: FloatArray, inputs: Inputs) -> FloatArray:
        """See `KinematicModel.twist`."""
        return _symmetric_twist(values[..., 0], values[..., 1], inputs)

    def parameter_jacobian(self, values: FloatArray, inputs: Inputs) -> FloatArray:
        """See `KinematicModel.parameter_jacobian`."""
        width = values[..., 1]
        by_alpha = _symmetric_twist(np.ones_like(width), width, inputs)
        omega = self.twist(values, inputs)[..., 2]
        zero = np.zeros_like(omega)
        by_width = np.stack([zero, zero, -omega / width], axis=-1)
        return np.stack([by_alpha, by_width], axis=-1)

    def speed_jacobian(self, values: FloatArray, inputs: Inputs) -> FloatArray:
        """See `KinematicModel.speed_jacobian`."""
        return _speed_matrix(values[..., 0], values[..., 1], inputs)

    def tread_speeds(self, values: FloatArray, v_x: FloatArray, omega: FloatArray) -> FloatArray:
        """See `InvertibleModel.tread_speeds`."""
        half = values[..., 1] / 2
        return before_slip(icr_tread_speeds(half, -half, v_x, omega), values[..., :1])

    def guess(self, robot: Robot) -> dict[str, float]:
        """A width of 1.5 track widths, no slip."""
        return {"alpha": 1.0, "b_hat": GUESSED_WIDTHS * robot.track_width}


def _symmetric_twist(alpha: FloatArray, width: FloatArray, inputs: Inputs) -> FloatArray:
    v_x = alpha * (inputs.left + inputs.right) / 2
    omega = alpha * (inputs.right - inputs.left) / width
    return np.stack([v_x, np.zeros_like(v_x), omega], axis=-1)


def _speed_matrix(alpha: FloatArray, width: FloatArray, inputs: Inputs) -> FloatArray:
    half, turn = alpha / 2, alpha / width
    zero = np.zeros_like(half)
    rows = [
        np.stack([half, half], axis=-1),
        np.stack([zero, zero], axis=-1),
        np.stack([-turn, turn], axis=-1),
    ]
    stack = np.broadcast_shapes(np.shape(half), inputs.shape)
    return np.broadcast_to(np.stack(rows, axis=-2), (*stack, 3, 2))
