"""Symmetric models: ideal differential drive, and one slip and one width for both treads."""

import numpy as np

from odometry.arrays import FloatArray
from odometry.errors import ParameterError
from odometry.models.base import USUAL_GAIN, IcrForm, Linearised, Parameter, vectors, zero_matrices
from odometry.models.icr import GUESSED_WIDTHS
from odometry.models.inputs import Inputs
from odometry.models.invertible import InvertibleModel, before_slip, icr_tread_speeds
from odometry.recording.run import Robot


class DifferentialDrive(InvertibleModel):
    """No slip at all (Baril 2020 eq. 3)."""

    name = "differential_drive"
    source = "Baril 2020, eq. 3"
    parameters = (Parameter("track_width", "m", 1e-3, known=True),)
    has_constant_icrs = True
    is_linear_in_speeds = True

    def twist(self, values: FloatArray, inputs: Inputs) -> FloatArray:
        """See `KinematicModel.twist`."""
        return _symmetric_twist(np.ones_like(values[..., 0]), values[..., 0], inputs)

    def linearised(self, values: FloatArray, inputs: Inputs) -> Linearised:
        """See `KinematicModel.linearised`."""
        twist = self.twist(values, inputs)
        jacobian = zero_matrices(twist.shape[:-1], 3, 1)
        jacobian[..., 2, 0] = -twist[..., 2] / values[..., 0]
        return Linearised(twist, jacobian)

    def speed_jacobian(self, values: FloatArray, inputs: Inputs) -> FloatArray:
        """See `KinematicModel.speed_jacobian`."""
        return _speed_matrix(np.ones_like(values[..., 0]), values[..., 0], inputs)

    def tread_speeds(self, values: FloatArray, v_x: FloatArray, omega: FloatArray) -> FloatArray:
        """See `InvertibleModel.tread_speeds`."""
        half = values[..., 0] / 2
        return icr_tread_speeds(half, -half, v_x, omega)

    def icr_form(self, values: FloatArray) -> IcrForm:
        """ICRs on the treads."""
        (width,) = values
        return IcrForm(
            symmetric_icrs(width), np.ones(2), np.append(symmetric_icrs(1.0), [0.0, 0.0])[:, None]
        )

    def guess(self, robot: Robot) -> dict[str, float]:
        """The track width."""
        return {"track_width": robot.track_width}


class IcrSymmetric(InvertibleModel):
    """One slip factor and one effective width (Baril 2020 eq. 8-9)."""

    name = "icr_symmetric"
    source = "Baril 2020, eq. 8-9"
    parameters = (
        Parameter("alpha", "", 0.0, 2.0, usual=USUAL_GAIN),
        Parameter("b_hat", "m", 1e-3),
    )
    has_constant_icrs = True
    is_linear_in_speeds = True

    def twist(self, values: FloatArray, inputs: Inputs) -> FloatArray:
        """See `KinematicModel.twist`."""
        return _symmetric_twist(values[..., 0], values[..., 1], inputs)

    def linearised(self, values: FloatArray, inputs: Inputs) -> Linearised:
        """See `KinematicModel.linearised`."""
        width = values[..., 1]
        twist = self.twist(values, inputs)
        jacobian = zero_matrices(twist.shape[:-1], 3, 2)
        jacobian[..., 0] = _symmetric_twist(np.ones_like(width), width, inputs)
        jacobian[..., 2, 1] = -twist[..., 2] / width
        return Linearised(twist, jacobian)

    def speed_jacobian(self, values: FloatArray, inputs: Inputs) -> FloatArray:
        """See `KinematicModel.speed_jacobian`."""
        return _speed_matrix(values[..., 0], values[..., 1], inputs)

    def tread_speeds(self, values: FloatArray, v_x: FloatArray, omega: FloatArray) -> FloatArray:
        """See `InvertibleModel.tread_speeds`."""
        half = values[..., 1] / 2
        return before_slip(icr_tread_speeds(half, -half, v_x, omega), values[..., :1])

    def icr_form(self, values: FloatArray) -> IcrForm:
        """Half the width on each side."""
        alpha, width = values
        by_parameters = np.zeros((5, 2))
        by_parameters[:3, 1], by_parameters[3:, 0] = symmetric_icrs(1.0), 1.0
        return IcrForm(symmetric_icrs(width), np.array([alpha, alpha]), by_parameters)

    def guess(self, robot: Robot) -> dict[str, float]:
        """A width of 1.5 track widths, no slip."""
        return {"alpha": 1.0, "b_hat": GUESSED_WIDTHS * robot.track_width}


def symmetric_icrs(width: float) -> FloatArray:
    """y_left, y_right, x_icr (3,) of an effective width [m]; linear in it."""
    return np.array([width / 2, -width / 2, 0.0])


def _symmetric_twist(alpha: FloatArray, width: FloatArray, inputs: Inputs) -> FloatArray:
    """Baril 2020 eq. 3, with alpha eq. 8-9."""
    v_x = alpha * (inputs.left + inputs.right) / 2
    omega = alpha * (inputs.right - inputs.left) / width
    return vectors(v_x, np.zeros(()), omega)


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
