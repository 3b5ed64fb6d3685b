"""What the models with a force of inertia share (Martinez 2017 eq. 17-30).

The paper has X right and Y forward: its x_ICR is our -y, its y_ICR our x_icr, its v_x our -v_y,
its v_y our v_x.
"""

from abc import abstractmethod
from dataclasses import dataclass

import numpy as np

from odometry.arrays import FloatArray
from odometry.models.base import KinematicModel, Linearised, Parameter
from odometry.models.icr import GUESSED_WIDTHS
from odometry.models.inertia_forces import (
    COEFFICIENTS,
    LEAST_ETA,
    PARAMETERS,
    SPEEDS,
    Column,
    ForceAt,
    Indices,
    by_coefficient,
    by_force,
    consistent_force,
    indices_under,
)
from odometry.models.inputs import Inputs
from odometry.recording.run import Robot

G_M_S2 = 9.80665
GUESSED_MASS_KG = 1.0  # the coefficients are then by acceleration
NEWTONS = {"m/N": 1, "1/N": 1, "1/N^2": 2}  # power of the force in a unit


@dataclass(frozen=True)
class Turn:
    """A motion under a force of inertia; stacks (...)."""

    inputs: Inputs
    omega: FloatArray  # [rad/s]
    indices: Indices

    @property
    def v_x(self) -> FloatArray:
        """Forward speed (...) [m/s] (Martinez 2017 eq. 22)."""
        return np.asarray(
            (self.inputs.left + self.inputs.right) / 2 - self.omega * self.indices.epsilon
        )

    @property
    def v_y(self) -> FloatArray:
        """Speed to the left (...) [m/s] (Martinez 2017 eq. 21)."""
        return np.asarray(-self.omega * self.indices.zeta)

    @property
    def twist(self) -> FloatArray:
        """Body twist (..., 3)."""
        return np.stack([self.v_x, self.v_y, self.omega], axis=-1)


class InertiaModel(KinematicModel):
    """Tread ICRs by indices of the force of inertia; a subclass computes that force.

    The force is held at the robot's weight, more than which no ordinary terrain can take up. H
    acts through the sign of V_l + H V_r alone: where that changes, the twist jumps, unless
    there is no force; the derivative by H is zero. The other derivatives jump where V_l = V_r,
    where eta is held at its least value and where the force is held at the weight.
    """

    parameters = (
        Parameter("zeta_0", "m"),
        Parameter("zeta_1", "m/N"),
        Parameter("epsilon_0", "m"),
        Parameter("epsilon_1", "m/N"),
        Parameter("eta_0", "", LEAST_ETA, search=(0.2, np.inf)),
        Parameter("eta_1", "1/N"),
        Parameter("eta_2", "1/N^2"),
        Parameter("h", "", 1e-3, search=(0.2, 3.0), in_sign=True),
        Parameter("mass", "kg", 1e-3, known=True),
        Parameter("x_cm", "m", known=True),
        Parameter("y_cm", "m", known=True),
        Parameter("track_width", "m", 1e-3, known=True),
    )

    @abstractmethod
    def caused_force(self, values: FloatArray, turn: Turn) -> tuple[FloatArray, FloatArray]:
        """Force of inertia (...) [N] in a motion, and its derivative (..., 3).

        By zeta, epsilon and omega, for whatever force the motion itself is under.
        """

    @abstractmethod
    def caused_force_gradient(self, values: FloatArray, turn: Turn) -> FloatArray:
        """Derivative (..., 14) of the same by each `Column`, at given zeta, epsilon and omega."""

    def icrs(self, values: FloatArray, inputs: Inputs) -> FloatArray:
        """Momentary y_left, y_right, x_icr (..., 3) [m] (Martinez 2017 eq. 28-30)."""
        found = self.turn(values, inputs).indices
        half = values[..., Column.TRACK_WIDTH] * found.eta / 2
        return np.stack([half - found.epsilon, -half - found.epsilon, found.zeta], axis=-1)

    def twist(self, values: FloatArray, inputs: Inputs) -> FloatArray:
        """See `KinematicModel.twist`."""
        return self.turn(values, inputs).twist

    def linearised(self, values: FloatArray, inputs: Inputs) -> Linearised:
        """See `KinematicModel.linearised`."""
        turn = self.turn(values, inputs)
        return Linearised(turn.twist, self.jacobian(values, turn)[..., PARAMETERS])

    def speed_jacobian(self, values: FloatArray, inputs: Inputs) -> FloatArray:
        """See `KinematicModel.speed_jacobian`."""
        return self.jacobian(values, self.turn(values, inputs))[..., SPEEDS]

    def guess(self, robot: Robot) -> dict[str, float]:
        """No effect of inertia on a width of 1.5 track widths, the mass in the middle."""
        guessed = dict.fromkeys((parameter.name for parameter in self.parameters), 0.0)
        mass = GUESSED_MASS_KG if robot.mass is None else robot.mass
        return guessed | {
            "eta_0": GUESSED_WIDTHS,
            "h": 1.0,
            "mass": mass,
            "track_width": robot.track_width,
        }

    def ordinary_sizes(self, robot: Robot) -> FloatArray:
        """See `KinematicModel.ordinary_sizes`; what is per newton, at 1 m/s^2."""
        mass = self.guess(robot)["mass"]
        return super().ordinary_sizes(robot) / [
            mass ** NEWTONS.get(parameter.unit, 0) for parameter in self.parameters
        ]

    def turn(self, values: FloatArray, inputs: Inputs) -> Turn:
        """The motion that causes the force of inertia which it is under."""
        stack = np.broadcast_shapes(values.shape[:-1], inputs.shape)
        limit_n = np.broadcast_to(values[..., Column.MASS] * G_M_S2, stack)
        in_a_row = values.ndim == 1 and len(stack) == 1
        force_n = consistent_force(
            self.force_at(values, inputs),
            limit_n,
            (lambda some: self.force_at(values, inputs.rows(some))) if in_a_row else None,
        )
        return self.turn_under(values, inputs, force_n)

    def turn_under(self, values: FloatArray, inputs: Inputs, force_n: FloatArray) -> Turn:
        """The motion under a force of inertia (...) [N]."""
        return _turn_under(values, inputs, force_n, signs_of(values, inputs))

    def force_at(self, values: FloatArray, inputs: Inputs) -> ForceAt:
        """The force that the motion under a force causes, and its derivative."""
        signs = signs_of(values, inputs)

        def force_at(force_n: FloatArray) -> tuple[FloatArray, FloatArray]:
            turn = _turn_under(values, inputs, force_n, signs)
            force, by_turn = self.caused_force(values, turn)
            return force, np.einsum("...i,...i->...", by_turn, _turn_by_force(values, turn))

        return force_at

    def jacobian(self, values: FloatArray, turn: Turn) -> FloatArray:
        """Derivative (..., 3, 14) of the twist by each `Column`."""
        given_force = _turn_gradient(values, turn)
        turn_by_force = _turn_by_force(values, turn)
        _, by_turn = self.caused_force(values, turn)
        direct = self.caused_force_gradient(values, turn)
        direct = direct + np.einsum("...i,...ij->...j", by_turn, given_force)
        feedback = (by_turn * turn_by_force).sum(axis=-1)[..., None]
        held = (turn.indices.force_n >= values[..., Column.MASS] * G_M_S2)[..., None]
        weight = np.zeros(len(Column))
        weight[Column.MASS] = G_M_S2
        force = np.where(held, weight, direct / np.where(held, 1, 1 - feedback))
        in_all = given_force + turn_by_force[..., :, None] * force[..., None, :]
        jacobian = _twist_by_turn(turn) @ in_all
        jacobian[..., 0, SPEEDS] += 0.5
        return np.asarray(jacobian)


def signs_of(values: FloatArray, inputs: Inputs) -> tuple[FloatArray, FloatArray]:
    """Those (...) of V_l - V_r and of V_l + H V_r (Martinez 2017 eq. 14-15)."""
    left, right = inputs.left, inputs.right
    return np.sign(left - right), np.sign(left + values[..., Column.H] * right)


def _turn_under(
    values: FloatArray, inputs: Inputs, force_n: FloatArray, signs: tuple[FloatArray, FloatArray]
) -> Turn:
    """The motion (...) under a force (...)."""
    found = indices_under(values[..., COEFFICIENTS], force_n, *signs)
    omega = (inputs.right - inputs.left) / (values[..., Column.TRACK_WIDTH] * found.eta)  # eq. 20
    return Turn(inputs, omega, found)


def _turn_by_force(values: FloatArray, turn: Turn) -> FloatArray:
    """Derivative (..., 3) of zeta, epsilon, omega by the force."""
    derivative = by_force(values[..., COEFFICIENTS], turn.indices)
    derivative[..., 2] *= -turn.omega / turn.indices.eta
    return derivative


def _turn_gradient(values: FloatArray, turn: Turn) -> FloatArray:
    """Derivative (..., 3, 14) of zeta, epsilon, omega by each `Column`, at one force."""
    gradient = np.zeros((*turn.omega.shape, 3, len(Column)))
    gradient[..., COEFFICIENTS] = by_coefficient(turn.indices)
    gradient[..., 2, COEFFICIENTS] *= (-turn.omega / turn.indices.eta)[..., None]
    gradient[..., 2, Column.TRACK_WIDTH] = -turn.omega / values[..., Column.TRACK_WIDTH]
    gradient[..., 2, Column.V_RIGHT] = 1 / (values[..., Column.TRACK_WIDTH] * turn.indices.eta)
    gradient[..., 2, Column.V_LEFT] = -gradient[..., 2, Column.V_RIGHT]
    return gradient


def _twist_by_turn(turn: Turn) -> FloatArray:
    """Derivative (..., 3, 3) of the twist by zeta, epsilon, omega (eq. 20-22)."""
    jacobian = np.zeros((*turn.omega.shape, 3, 3))
    jacobian[..., 0, 1] = jacobian[..., 1, 0] = -turn.omega
    jacobian[..., 0, 2] = -turn.indices.epsilon
    jacobian[..., 1, 2] = -turn.indices.zeta
    jacobian[..., 2, 2] = 1
    return jacobian
