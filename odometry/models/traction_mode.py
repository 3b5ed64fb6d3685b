"""Traction modes: one factor for driving and one for turning (Salvi 2024 eq. 3)."""

import numpy as np

from odometry.arrays import FloatArray
from odometry.models.base import Parameter
from odometry.models.icr import GUESSED_WIDTHS
from odometry.models.inputs import Inputs
from odometry.models.invertible import InvertibleModel, before_slip, icr_tread_speeds
from odometry.run import Robot


class TractionMode(InvertibleModel):
    """Requested forward speed times k, requested turn rate times m.

    The same twists as `icr_symmetric` with alpha = k and b_hat = track_width k / m.
    """

    name = "traction_mode"
    source = "Salvi 2024, eq. 3"
    parameters = (
        Parameter("k", "", 0.0, 2.0),
        Parameter("m", "", 0.0, 2.0),
        Parameter("track_width", "m", 1e-3, known=True),
    )

    def twist(self, values: FloatArray, inputs: Inputs) -> FloatArray:
        """See `KinematicModel.twist`."""
        k, m, width = np.moveaxis(values, -1, 0)
        v_x = k * (inputs.left + inputs.right) / 2  # eq. 3, k u_1
        omega = m * (inputs.right - inputs.left) / width  # eq. 3, m u_2
        return np.stack([v_x, np.zeros_like(v_x), omega], axis=-1)

    def parameter_jacobian(self, values: FloatArray, inputs: Inputs) -> FloatArray:
        """See `KinematicModel.parameter_jacobian`."""
        _, m, width = np.moveaxis(values, -1, 0)
        forward = (inputs.left + inputs.right) / 2
        turn = (inputs.right - inputs.left) / width
        jacobian = np.zeros((*np.broadcast_shapes(m.shape, inputs.shape), 3, 3))
        jacobian[..., 0, 0] = forward
        jacobian[..., 2, 1] = turn
        jacobian[..., 2, 2] = -m * turn / width
        return jacobian

    def speed_jacobian(self, values: FloatArray, inputs: Inputs) -> FloatArray:
        """See `KinematicModel.speed_jacobian`."""
        k, m, width = np.moveaxis(values, -1, 0)
        jacobian = np.zeros((*np.broadcast_shapes(m.shape, inputs.shape), 3, 2))
        jacobian[..., 0, :] = k[..., None] / 2
        jacobian[..., 2, :] = (m / width)[..., None] * [-1.0, 1.0]
        return jacobian

    def tread_speeds(self, values: FloatArray, v_x: FloatArray, omega: FloatArray) -> FloatArray:
        """See `InvertibleModel.tread_speeds`."""
        k, m, width = np.moveaxis(values, -1, 0)
        half = width / 2
        return icr_tread_speeds(half, -half, before_slip(v_x, k), before_slip(omega, m))

    def guess(self, robot: Robot) -> dict[str, float]:
        """No loss forward, the turn rate of a width of 1.5 track widths."""
        return {"k": 1.0, "m": 1 / GUESSED_WIDTHS, "track_width": robot.track_width}
