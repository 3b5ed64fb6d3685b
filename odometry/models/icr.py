"""Extended differential drive: one ICR for each tread (Baril 2020 eq. 7, Chen 2023 eq. 3)."""

from collections.abc import Sequence
from dataclasses import replace

import numpy as np

from odometry.arrays import FloatArray, IntArray
from odometry.errors import ParameterError
from odometry.models.base import USUAL_GAIN, IcrForm, Linearised, Parameter, vectors, zero_matrices
from odometry.models.inputs import Inputs
from odometry.models.invertible import InvertibleModel, before_slip, icr_tread_speeds
from odometry.recording.run import Robot

ICRS, ALPHAS = slice(0, 3), slice(3, 5)  # where the parameters of `icr` have them
GUESSED_WIDTHS = 1.5  # distance between tread ICRs in track widths, where nothing else is known


def icr_twist(icrs: FloatArray, tread_speeds: FloatArray) -> FloatArray:
    """Body twist from tread ICRs (Martinez 2024 eq. 4 in other axes).

    Parameters
    ----------
    icrs : (..., 3)
        y_left, y_right, x_icr [m] in the robot frame, y_left > y_right.
    tread_speeds : (..., 2)
        Effective tread speeds, left and right [m/s].

    Returns
    -------
    (..., 3)
        v_x, v_y [m/s], omega [rad/s].
    """
    icrs, tread_speeds = np.asarray(icrs), np.asarray(tread_speeds)
    y_left, y_right, x_icr = icrs[..., 0], icrs[..., 1], icrs[..., 2]
    left, right = tread_speeds[..., 0], tread_speeds[..., 1]
    width = y_left - y_right
    omega = (right - left) / width  # Chen 2023 eq. 3, third row
    v_x = (right * y_left - left * y_right) / width  # Chen 2023 eq. 3, first row
    return vectors(v_x, -x_icr * omega, omega)


def icr_twist_jacobian(icrs: FloatArray, tread_speeds: FloatArray) -> FloatArray:
    """Derivative (..., 3, 3) of `icr_twist` by (y_left, y_right, x_icr).

    This is Chen 2023 eq. 10 in the body frame, with its misprints corrected.
    """
    omega = icr_twist(icrs, tread_speeds)[..., 2]
    jacobian = zero_matrices(np.shape(omega), 3, 3)
    fill_by_icrs(jacobian, np.asarray(icrs), omega)
    return jacobian


def fill_by_icrs(jacobian: FloatArray, icrs: FloatArray, omega: FloatArray) -> None:
    """Put the derivative by ICRs (..., 3) into the first columns of a zero matrix (..., 3, P).

    `omega` (...) is that of the twist [rad/s].
    """
    y_left, y_right, x_icr = np.moveaxis(icrs, -1, 0)
    rate = omega / (y_left - y_right)
    jacobian[..., 0, 0], jacobian[..., 0, 1] = -y_right * rate, y_left * rate
    jacobian[..., 1, 0], jacobian[..., 1, 1] = x_icr * rate, -x_icr * rate
    jacobian[..., 1, 2] = -omega
    jacobian[..., 2, 0], jacobian[..., 2, 1] = -rate, rate


def icr_speed_matrix(icrs: FloatArray) -> FloatArray:
    """Derivative (..., 3, 2) of `icr_twist` by the effective tread speeds (Baril 2020 eq. 7)."""
    y_left, y_right, x_icr = np.moveaxis(np.asarray(icrs), -1, 0)
    one = np.ones_like(y_left)
    rows = [
        np.stack([-y_right, y_left], axis=-1),
        np.stack([x_icr, -x_icr], axis=-1),
        np.stack([-one, one], axis=-1),
    ]
    return np.asarray(np.stack(rows, axis=-2) / (y_left - y_right)[..., None, None])


class Icr(InvertibleModel):
    """Asymmetric ICRs with a slip factor for each tread (Baril 2020 eq. 7)."""

    name = "icr"
    source = "Baril 2020, eq. 7"
    parameters: tuple[Parameter, ...] = (
        Parameter("y_left", "m", search=(1e-3, np.inf)),
        Parameter("y_right", "m", search=(-np.inf, -1e-3)),
        Parameter("x_icr", "m"),
        Parameter("alpha_left", "", 0.0, 2.0, default=1.0, usual=USUAL_GAIN),
        Parameter("alpha_right", "", 0.0, 2.0, default=1.0, usual=USUAL_GAIN),
    )
    has_constant_icrs = True
    is_linear_in_speeds = True

    def check(self, values: FloatArray) -> None:
        """y_left must exceed y_right."""
        if values[0] <= values[1]:
            raise ParameterError(
                f"y_left = {values[0]} and y_right = {values[1]}, expected y_left > y_right"
            )

    def twist(self, values: FloatArray, inputs: Inputs) -> FloatArray:
        """See `KinematicModel.twist`."""
        return icr_twist(values[..., ICRS], values[..., ALPHAS] * inputs.tread_speeds_m_s)

    def linearised(self, values: FloatArray, inputs: Inputs) -> Linearised:
        """See `KinematicModel.linearised`."""
        twist = self.twist(values, inputs)
        jacobian = zero_matrices(twist.shape[:-1], 3, 5)
        fill_by_icrs(jacobian, values[..., ICRS], twist[..., 2])
        by_speed = icr_speed_matrix(values[..., ICRS])
        for tread, speed in enumerate((inputs.left, inputs.right)):
            by_alpha = jacobian[..., ALPHAS][..., tread]
            np.multiply(by_speed[..., tread], speed[..., None], out=by_alpha)
        return Linearised(twist, jacobian)

    def speed_jacobian(self, values: FloatArray, inputs: Inputs) -> FloatArray:
        """See `KinematicModel.speed_jacobian`."""
        matrix = icr_speed_matrix(values[..., ICRS]) * values[..., None, ALPHAS]
        stack = np.broadcast_shapes(matrix.shape[:-2], inputs.shape)
        return np.asarray(np.broadcast_to(matrix, (*stack, 3, 2)))

    def tread_speeds(self, values: FloatArray, v_x: FloatArray, omega: FloatArray) -> FloatArray:
        """See `InvertibleModel.tread_speeds`."""
        effective = icr_tread_speeds(values[..., 0], values[..., 1], v_x, omega)
        return before_slip(effective, values[..., ALPHAS])

    def icr_form(self, values: FloatArray) -> IcrForm:
        """The parameters themselves."""
        return IcrForm(values[ICRS], values[ALPHAS], np.eye(5))

    def guess(self, robot: Robot) -> dict[str, float]:
        """Tread ICRs 1.5 times as far apart as the treads, no slip."""
        half = GUESSED_WIDTHS * robot.track_width / 2
        return {
            "y_left": half,
            "y_right": -half,
            "x_icr": 0.0,
            "alpha_left": 1.0,
            "alpha_right": 1.0,
        }


PLAIN = Icr()
COUNT = len(PLAIN.parameters)


class IcrByTerrain(Icr):
    """`Icr` with parameters of its own for each labelled terrain, one after the other.

    Attributes
    ----------
    labels : tuple of str
        The parameters of the first are those of samples with another label or none.
    """

    has_constant_icrs = False
    is_linear_in_speeds = False

    def __init__(self, labels: Sequence[str]) -> None:
        self.labels = tuple(labels)
        others = (
            replace(parameter, name=f"{parameter.name}_{label}")
            for label in self.labels[1:]
            for parameter in Icr.parameters
        )
        self.parameters = (*Icr.parameters, *others)

    def values_on(self, label: str, values: FloatArray) -> FloatArray:
        """Parameters (5,) of `icr` on a terrain, of those (P,) of all."""
        number = self.labels.index(label) if label in self.labels else 0
        return np.asarray(values[number * COUNT : (number + 1) * COUNT])

    def check(self, values: FloatArray) -> None:
        """y_left must exceed y_right on each terrain."""
        for own in values.reshape(-1, COUNT):
            PLAIN.check(own)

    def twist(self, values: FloatArray, inputs: Inputs) -> FloatArray:
        """See `KinematicModel.twist`; values (P,), inputs of stack (N,)."""
        return PLAIN.twist(self._of_samples(values, inputs), inputs)

    def linearised(self, values: FloatArray, inputs: Inputs) -> Linearised:
        """See `KinematicModel.linearised`; values (P,), inputs of stack (N,)."""
        twist, own = PLAIN.linearised(self._of_samples(values, inputs), inputs)
        jacobian = zero_matrices(inputs.shape, 3, len(self.parameters))
        for number in range(len(self.labels)):
            here = self._numbers(inputs) == number
            jacobian[here, :, number * COUNT : (number + 1) * COUNT] = own[here]
        return Linearised(twist, jacobian)

    def speed_jacobian(self, values: FloatArray, inputs: Inputs) -> FloatArray:
        """See `KinematicModel.speed_jacobian`; values (P,), inputs of stack (N,)."""
        return PLAIN.speed_jacobian(self._of_samples(values, inputs), inputs)

    def guess(self, robot: Robot) -> dict[str, float]:
        """Those of `icr`, the same on all terrains."""
        guess = PLAIN.guess(robot)
        names = [parameter.name for parameter in self.parameters]
        values = [guess[parameter.name] for parameter in Icr.parameters] * len(self.labels)
        return dict(zip(names, values, strict=True))

    def _of_samples(self, values: FloatArray, inputs: Inputs) -> FloatArray:
        return np.asarray(values.reshape(-1, COUNT)[self._numbers(inputs)])

    def _numbers(self, inputs: Inputs) -> IntArray:
        numbers = np.zeros(inputs.shape, dtype=np.int64)
        for number, label in enumerate(self.labels):
            if inputs.terrain is not None:
                numbers[np.asarray(inputs.terrain) == label] = number
        return numbers
