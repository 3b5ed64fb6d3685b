"""Full linear model: six free coefficients (Baril 2020 eq. 12)."""

import numpy as np

from odometry.arrays import FloatArray
from odometry.models.base import KinematicModel, Linearised, Parameter, zero_matrices
from odometry.models.icr import GUESSED_WIDTHS
from odometry.models.inputs import Inputs
from odometry.run import Robot


class FullLinear(KinematicModel):
    """Body twist as a matrix (3, 2) times the tread speeds.

    The gammas multiply tread speeds in m/s: eq. 12 lacks the wheel radius that Table I's
    coefficients need.
    """

    name = "full_linear"
    source = "Baril 2020, eq. 12"
    parameters = (
        Parameter("gamma_11"),
        Parameter("gamma_12"),
        Parameter("gamma_21"),
        Parameter("gamma_22"),
        Parameter("gamma_31", "1/m", high=0.0),  # bounds of Table I: a left turn is omega > 0
        Parameter("gamma_32", "1/m", low=0.0),
    )
    is_linear_in_speeds = True

    def twist(self, values: FloatArray, inputs: Inputs) -> FloatArray:
        """See `KinematicModel.twist`."""
        return np.asarray(np.einsum("...ij,...j->...i", _matrix(values), inputs.tread_speeds_m_s))

    def linearised(self, values: FloatArray, inputs: Inputs) -> Linearised:
        """See `KinematicModel.linearised`."""
        twist = self.twist(values, inputs)
        jacobian = zero_matrices(twist.shape[:-1], 3, 6)
        for row in range(3):
            jacobian[..., row, 2 * row : 2 * row + 2] = inputs.tread_speeds_m_s
        return Linearised(twist, jacobian)

    def speed_jacobian(self, values: FloatArray, inputs: Inputs) -> FloatArray:
        """See `KinematicModel.speed_jacobian`."""
        stack = np.broadcast_shapes(values.shape[:-1], inputs.shape)
        return np.asarray(np.broadcast_to(_matrix(values), (*stack, 3, 2)))

    def guess(self, robot: Robot) -> dict[str, float]:
        """No loss forward, no lateral motion, a width of 1.5 track widths."""
        turn = 1 / (GUESSED_WIDTHS * robot.track_width)
        guessed = (0.5, 0.5, 0.0, 0.0, -turn, turn)
        names = (parameter.name for parameter in self.parameters)
        return dict(zip(names, guessed, strict=True))


def _matrix(values: FloatArray) -> FloatArray:
    return np.reshape(values, (*np.shape(values)[:-1], 3, 2))
