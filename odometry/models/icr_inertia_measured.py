"""Tread ICRs moved by the inertia that an accelerometer measures (Martinez 2017 eq. 17-30)."""

import numpy as np

from odometry.arrays import FloatArray
from odometry.errors import ParameterError
from odometry.models.inertia_columns import CENTRE_OF_MASS, Column
from odometry.models.inertia_model import G_M_S2, InertiaModel, Turn


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
