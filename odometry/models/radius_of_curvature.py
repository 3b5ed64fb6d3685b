"""Models of Baril 2020: width by the radius of curvature (eq. 10-11), and full linear (eq. 12)."""

import numpy as np

from odometry.arrays import FloatArray
from odometry.errors import ParameterError
from odometry.models.base import (
    USUAL_GAIN,
    KinematicModel,
    Linearised,
    Parameter,
    vectors,
    zero_matrices,
)
from odometry.models.icr import GUESSED_WIDTHS
from odometry.models.inputs import Inputs
from odometry.recording.run import Robot


class RadiusOfCurvature(KinematicModel):
    """Symmetric model whose width narrows from turning on the spot to driving straight.

    With lambda = |(right + left) / (right - left)| (eq. 10) the width 2 y_0 of eq. 11 is
    track_width (1 + beta_1 / (1 + beta_2 sqrt(lambda))). Computed is its inverse, by |right -
    left| and |right + left|, so that nothing is divided by zero:

    - straight (lambda infinite), beta_2 > 0: the width is the track width;
    - beta_2 = 0: the width is track_width (1 + beta_1) everywhere;
    - beta_2 < 0: the width has a pole at sqrt(lambda) = -1 / beta_2 and is negative above. The
      inverse width is held at 0 there: on straighter paths than that the robot does not turn.

    At a standstill the speed Jacobian is that of turning on the spot. Exactly on the spot
    (right = -left) sqrt(lambda) has an infinite slope; the Jacobian takes the mean of both
    sides, in which it drops out.
    """

    name = "radius_of_curvature"
    source = "Baril 2020, eq. 8 with eq. 10-11"
    parameters = (
        Parameter("alpha", "", 0.0, 2.0, usual=USUAL_GAIN),
        Parameter("beta_1", "", -0.99, search=(-0.9, 1e3)),
        Parameter("beta_2", "", search=(0.0, 1e3), neutral=0.0),
        Parameter("track_width", "m", 1e-3, known=True),
    )

    def check(self, values: FloatArray) -> None:
        """Where beta_2 < 0, beta_1 < 0 would let the width fall to zero on a curve."""
        if values[1] < 0 and values[2] < 0:
            raise ParameterError(
                f"beta_1 = {values[1]} and beta_2 = {values[2]}, expected one of them at least 0"
            )

    def twist(self, values: FloatArray, inputs: Inputs) -> FloatArray:
        """See `KinematicModel.twist`."""
        factor, *_ = _width_factor(values, inputs)
        return _twist(values, inputs, factor)

    def linearised(self, values: FloatArray, inputs: Inputs) -> Linearised:
        """See `KinematicModel.linearised`."""
        alpha, _, _, width = np.moveaxis(values, -1, 0)
        factor, by_beta_1, by_beta_2, _, _ = _width_factor(values, inputs)
        turn = (inputs.right - inputs.left) / width
        jacobian = zero_matrices(np.shape(factor), 3, 4)
        jacobian[..., 0, 0] = (inputs.left + inputs.right) / 2
        jacobian[..., 2, 0] = turn * factor
        jacobian[..., 2, 1] = alpha * turn * by_beta_1
        jacobian[..., 2, 2] = alpha * turn * by_beta_2
        jacobian[..., 2, 3] = -alpha * turn * factor / width
        return Linearised(_twist(values, inputs, factor), jacobian)

    def speed_jacobian(self, values: FloatArray, inputs: Inputs) -> FloatArray:
        """See `KinematicModel.speed_jacobian`."""
        alpha, _, _, width = np.moveaxis(values, -1, 0)
        factor, _, _, by_difference, by_sum = _width_factor(values, inputs)
        by_sum = by_sum * np.sign(inputs.right - inputs.left) * np.sign(inputs.right + inputs.left)
        jacobian = np.zeros((*np.shape(factor), 3, 2))
        jacobian[..., 0, :] = alpha[..., None] / 2
        jacobian[..., 2, 0] = alpha / width * (by_sum - factor - by_difference)
        jacobian[..., 2, 1] = alpha / width * (by_sum + factor + by_difference)
        return jacobian

    def guess(self, robot: Robot) -> dict[str, float]:
        """A width of 1.5 track widths at lambda = 1, no slip."""
        return {
            "alpha": 1.0,
            "beta_1": 2 * (GUESSED_WIDTHS - 1),
            "beta_2": 1.0,
            "track_width": robot.track_width,
        }


def _twist(values: FloatArray, inputs: Inputs, factor: FloatArray) -> FloatArray:
    alpha, _, _, width = np.moveaxis(values, -1, 0)
    v_x = alpha * (inputs.left + inputs.right) / 2
    omega = alpha * (inputs.right - inputs.left) / width * factor  # eq. 8
    return vectors(v_x, np.zeros(()), omega)


def _width_factor(values: FloatArray, inputs: Inputs) -> tuple[FloatArray, ...]:
    """Track width over effective width, (...), and how it changes.

    With p = sqrt(|right - left|) and q = sqrt(|right + left|), lambda of eq. 10 is q^2 / p^2, and
    eq. 11 turns into factor = (p + beta_2 q) / ((1 + beta_1) p + beta_2 q).

    Returns
    -------
    tuple of (...)
        The factor; its derivatives by beta_1 and beta_2; and |right - left| times its
        derivatives by |right - left| and by |right + left|.
    """
    _, beta_1, beta_2, _ = np.moveaxis(values, -1, 0)
    p = np.sqrt(np.abs(inputs.right - inputs.left))
    q = np.sqrt(np.abs(inputs.right + inputs.left))
    above, below = p + beta_2 * q, (1 + beta_1) * p + beta_2 * q
    turns = (above > 0) & (below > 0)
    below = np.where(turns, below, 1.0)
    still = np.where((p == 0) & (beta_2 * q == 0), 1 / (1 + beta_1), 0.0)  # the limit p = 0
    factor = np.where(turns, above / below, still)
    rate = np.where(turns, beta_1 * p / below**2, 0.0)
    by_sum = np.zeros_like(rate)
    np.divide(beta_2 * p**2 * rate, 2 * q, out=by_sum, where=q > 0)
    return (
        factor,
        np.where(turns, -above * p / below**2, 0.0),
        q * rate,
        -beta_2 * q * rate / 2,
        by_sum,
    )


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
