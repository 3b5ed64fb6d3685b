"""Traction modes: one factor for driving and one for turning (Salvi 2024 eq. 3)."""

import numpy as np

from odometry.arrays import FloatArray
from odometry.errors import ParameterError
from odometry.models.base import USUAL_GAIN, IcrForm, Linearised, Parameter
from odometry.models.icr import GUESSED_WIDTHS
from odometry.models.inputs import Inputs
from odometry.models.invertible import InvertibleModel, before_slip, icr_tread_speeds
from odometry.models.layout import vectors, zero_matrices
from odometry.models.symmetric import symmetric_icrs
from odometry.run import Robot


class TractionMode(InvertibleModel):
    """Requested forward speed times k, requested turn rate times m.

    The same twists as `icr_symmetric` with alpha = k and b_hat = track_width k / m.
    """

    name = "traction_mode"
    source = "Salvi 2024, eq. 3"
    parameters = (
        Parameter("k", "", 0.0, 2.0, usual=USUAL_GAIN),
        Parameter("m", "", 0.0, 2.0),
        Parameter("track_width", "m", 1e-3, known=True),
    )
    has_constant_icrs = True
    is_linear_in_speeds = True

    def twist(self, values: FloatArray, inputs: Inputs) -> FloatArray:
        """See `KinematicModel.twist`."""
        k, m, width = np.moveaxis(values, -1, 0)
        v_x = k * (inputs.left + inputs.right) / 2  # eq. 3, k u_1
        omega = m * (inputs.right - inputs.left) / width  # eq. 3, m u_2
        return vectors(v_x, np.zeros(()), omega)

    def linearised(self, values: FloatArray, inputs: Inputs) -> Linearised:
        """See `KinematicModel.linearised`."""
        _, m, width = np.moveaxis(values, -1, 0)
        twist = self.twist(values, inputs)
        turn = (inputs.right - inputs.left) / width
        jacobian = zero_matrices(twist.shape[:-1], 3, 3)
        jacobian[..., 0, 0] = (inputs.left + inputs.right) / 2
        jacobian[..., 2, 1] = turn
        jacobian[..., 2, 2] = -m * turn / width
        return Linearised(twist, jacobian)

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

    def icr_form(self, values: FloatArray) -> IcrForm:
        """Both factors k, and y_left - y_right = track_width k / m; see `KinematicModel.icr_form`.

        Raises
        ------
        ParameterError
            If k or m is 0: no tread ICRs make such a motion.
        """
        k, m, track_width = values
        if m * k <= 0:
            raise ParameterError(f"k = {k} and m = {m}, expected both above 0")
        width = track_width * k / m
        by_parameters = np.zeros((5, 3))
        by_parameters[:3] = np.outer(symmetric_icrs(1.0), [track_width / m, -width / m, k / m])
        by_parameters[3:, 0] = 1.0
        return IcrForm(symmetric_icrs(width), np.array([k, k]), by_parameters)

    def guess(self, robot: Robot) -> dict[str, float]:
        """No loss forward, the turn rate of a width of 1.5 track widths."""
        return {"k": 1.0, "m": 1 / GUESSED_WIDTHS, "track_width": robot.track_width}
