"""Tread ICRs moved by inertia, of the model's own motion or measured (Martinez 2017 eq. 4-30)."""

import numpy as np

from odometry.arrays import FloatArray
from odometry.errors import ParameterError
from odometry.models.base import vectors
from odometry.models.inertia_forces import (
    CENTRE_OF_MASS,
    COEFFICIENTS,
    Column,
    consistent_force,
    indices_under,
)
from odometry.models.inertia_model import G_M_S2, InertiaModel, Turn
from odometry.models.invertible import InvertibleModel, icr_tread_speeds


class IcrInertia(InertiaModel, InvertibleModel):
    """The force of inertia is that of the steady motion which the model itself predicts.

    The indices are those that the paper prints. The product of signs in eq. 26 and 27 reversed,
    with which the printed coefficients come nearer to the paper's own mean ICRs, is said by
    epsilon_1 and eta_1 of the other sign.
    """

    name = "icr_inertia"
    source = "Martinez 2017, eq. 4-30"

    def caused_force(self, values: FloatArray, turn: Turn) -> tuple[FloatArray, FloatArray]:
        """See `InertiaModel.caused_force` (Martinez 2017 eq. 11)."""
        mass, x_cm, y_cm = (values[..., c] for c in (Column.MASS, Column.X_CM, Column.Y_CM))
        zeta, epsilon, omega = turn.indices.zeta, turn.indices.epsilon, turn.omega
        speed, ahead, left = _centre_of_mass(values, turn.v_x, omega, zeta)
        momentum_rate = mass * np.abs(omega)
        by_omega = left * (x_cm - zeta) - ahead * (y_cm + epsilon)
        by_turn = (
            -momentum_rate * left * omega,
            -momentum_rate * ahead * omega,
            momentum_rate * by_omega + mass * np.sign(omega) * speed,
        )
        return momentum_rate * speed, vectors(*by_turn)

    def caused_force_gradient(self, values: FloatArray, turn: Turn) -> FloatArray:
        """See `InertiaModel.caused_force_gradient`."""
        speed, ahead, left = _centre_of_mass(values, turn.v_x, turn.omega, turn.indices.zeta)
        momentum_rate = values[..., Column.MASS] * np.abs(turn.omega)
        gradient = np.zeros((*turn.omega.shape, len(Column)))
        gradient[..., Column.MASS] = np.abs(turn.omega) * speed
        gradient[..., Column.X_CM] = momentum_rate * left * turn.omega
        gradient[..., Column.Y_CM] = -momentum_rate * ahead * turn.omega
        gradient[..., Column.V_LEFT] = gradient[..., Column.V_RIGHT] = momentum_rate * ahead / 2
        return gradient

    def tread_speeds(self, values: FloatArray, v_x: FloatArray, omega: FloatArray) -> FloatArray:
        """See `InvertibleModel.tread_speeds` (Martinez 2017 eq. 23-24).

        Both signs of V_l + H V_r are supposed, and speeds that come out with the sign supposed
        are kept, those of the positive one first. Near turning on the spot neither sign may
        come out, or both: the twist jumps there, leaving out some motions and making others
        twice.
        """
        speeds = np.full(
            (*np.broadcast_shapes(values.shape[:-1], v_x.shape, omega.shape), 2), np.nan
        )
        for x2_sign in (-1.0, 1.0):
            supposed = _tread_speeds(values, v_x, omega, x2_sign)
            x2 = supposed[..., 0] + values[..., Column.H] * supposed[..., 1]  # eq. 15
            agrees = (np.sign(x2) != -x2_sign) | (omega == 0)
            speeds = np.where(agrees[..., None], supposed, speeds)
        return speeds


def _centre_of_mass(
    values: FloatArray, v_x: FloatArray, omega: FloatArray, zeta: FloatArray
) -> tuple[FloatArray, FloatArray, FloatArray]:
    """Speed (...) of the centre of mass, and the direction in which it moves (eq. 9)."""
    ahead = v_x - values[..., Column.Y_CM] * omega
    left = (values[..., Column.X_CM] - zeta) * omega
    speed = np.sqrt(ahead**2 + left**2)
    moving = np.where(speed > 0, speed, 1.0)
    return speed, ahead / moving, left / moving


def _tread_speeds(
    values: FloatArray, v_x: FloatArray, omega: FloatArray, x2_sign: float
) -> FloatArray:
    """Tread speeds (..., 2) if V_l + H V_r has the sign supposed."""
    mass, track_width = values[..., Column.MASS], values[..., Column.TRACK_WIDTH]
    slide = values[..., Column.ZETA_1] * x2_sign  # of zeta by the force

    def force_at(force_n: FloatArray) -> tuple[FloatArray, FloatArray]:
        zeta = values[..., Column.ZETA_0] + slide * force_n
        speed, _, left = _centre_of_mass(values, v_x, omega, zeta)
        return mass * np.abs(omega) * speed, -mass * np.abs(omega) * left * omega * slide

    stack = np.broadcast_shapes(mass.shape, v_x.shape, omega.shape)
    force_n = consistent_force(force_at, np.broadcast_to(mass * G_M_S2, stack))
    found = indices_under(values[..., COEFFICIENTS], force_n, -np.sign(omega), np.asarray(x2_sign))
    half = track_width * found.eta / 2
    return icr_tread_speeds(half - found.epsilon, -half - found.epsilon, v_x, omega)


class IcrInertiaMeasured(InertiaModel):
    """The force of inertia is mass times the measured acceleration of the centre of mass.

    Gravity is taken off by roll and pitch. From the robot's origin, where the accelerations are
    measured, they are carried to the centre of mass by -omega^2 r with the model's own omega;
    the angular acceleration is neglected.
    """

    name = "icr_inertia_measured"
    source = "Martinez 2017, eq. 17-30, |F| from accelerations as its conclusions propose"

    def caused_force(self, values: FloatArray, turn: Turn) -> tuple[FloatArray, FloatArray]:
        """See `InertiaModel.caused_force`."""
        size, direction = _acceleration(values, turn)
        inward = (direction * values[..., CENTRE_OF_MASS]).sum(axis=-1)
        by_turn = np.zeros((*size.shape, 3))
        by_turn[..., 2] = -2 * values[..., Column.MASS] * turn.omega * inward
        return values[..., Column.MASS] * size, by_turn

    def caused_force_gradient(self, values: FloatArray, turn: Turn) -> FloatArray:
        """See `InertiaModel.caused_force_gradient`."""
        size, direction = _acceleration(values, turn)
        gradient = np.zeros((*size.shape, len(Column)))
        gradient[..., Column.MASS] = size
        gradient[..., CENTRE_OF_MASS] = (
            -(values[..., Column.MASS] * turn.omega**2)[..., None] * direction
        )
        return gradient


def _acceleration(values: FloatArray, turn: Turn) -> tuple[FloatArray, FloatArray]:
    """Size (...) [m/s^2] and direction (..., 2) of the centre of mass's acceleration."""
    inputs = turn.inputs
    if inputs.accelerations_m_s2 is None:
        raise ParameterError(
            "the model 'icr_inertia_measured' needs accel_x and accel_y, and none were recorded; "
            "'icr_inertia' does without"
        )
    level = G_M_S2 * np.stack(
        np.broadcast_arrays(
            -np.sin(inputs.pitch_rad), np.cos(inputs.pitch_rad) * np.sin(inputs.roll_rad)
        ),
        axis=-1,
    )
    carried = (
        inputs.accelerations_m_s2 - level - turn.omega[..., None] ** 2 * values[..., CENTRE_OF_MASS]
    )
    size = np.hypot(carried[..., 0], carried[..., 1])
    return size, carried / np.where(size > 0, size, 1.0)[..., None]
