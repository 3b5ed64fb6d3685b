"""Extended differential drive: one ICR for each tread (Baril 2020 eq. 7, Chen 2023 eq. 3)."""

import numpy as np

from odometry.arrays import FloatArray
from odometry.errors import ParameterError
from odometry.models.base import KinematicModel, Parameter


def icr_twist(icrs: FloatArray, tread_speeds: FloatArray) -> FloatArray:
    """Body twist from tread ICRs.

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
    y_left, y_right, x_icr = np.moveaxis(np.asarray(icrs), -1, 0)
    left, right = np.moveaxis(np.asarray(tread_speeds), -1, 0)
    width = y_left - y_right
    omega = (right - left) / width  # Chen 2023 eq. 3, third row
    v_x = (right * y_left - left * y_right) / width  # Chen 2023 eq. 3, first row
    return np.stack([v_x, -x_icr * omega, omega], axis=-1)


def icr_twist_jacobian(icrs: FloatArray, tread_speeds: FloatArray) -> FloatArray:
    """Derivative (..., 3, 3) of `icr_twist` by (y_left, y_right, x_icr).

    This is Chen 2023 eq. 10 in the body frame, with its misprints mended.
    """
    y_left, y_right, x_icr = np.moveaxis(np.asarray(icrs), -1, 0)
    omega = icr_twist(icrs, tread_speeds)[..., 2]
    rate = omega / (y_left - y_right)
    zero = np.zeros_like(rate)
    return np.stack(
        [
            np.stack([-y_right * rate, y_left * rate, zero], axis=-1),
            np.stack([x_icr * rate, -x_icr * rate, -omega], axis=-1),
            np.stack([-rate, rate, zero], axis=-1),
        ],
        axis=-2,
    )


class Icr(KinematicModel):
    """Asymmetric ICRs with a slip factor for each tread (Baril 2020 eq. 7)."""

    name = "icr"
    source = "Baril 2020, eq. 7"
    parameters = (
        Parameter("y_left", "m"),
        Parameter("y_right", "m"),
        Parameter("x_icr", "m"),
        Parameter("alpha_left", "", 0.0, 2.0, default=1.0),
        Parameter("alpha_right", "", 0.0, 2.0, default=1.0),
    )

    def check(self, values: FloatArray) -> None:
        """y_left must exceed y_right."""
        if values[0] <= values[1]:
            raise ParameterError(
                f"y_left = {values[0]} and y_right = {values[1]}, expected y_left > y_right"
            )

    def twist(self, values: FloatArray, tread_speeds: FloatArray) -> FloatArray:
        """See `KinematicModel.twist`."""
        return icr_twist(values[..., :3], values[..., 3:] * tread_speeds)

    def parameter_jacobian(self, values: FloatArray, tread_speeds: FloatArray) -> FloatArray:
        """See `KinematicModel.parameter_jacobian`."""
        by_icr = icr_twist_jacobian(values[..., :3], values[..., 3:] * tread_speeds)
        by_effective_speed = _speed_matrix(values[..., :3])
        by_alpha = by_effective_speed * np.asarray(tread_speeds)[..., None, :]
        return np.concatenate([by_icr, by_alpha], axis=-1)

    def speed_jacobian(self, values: FloatArray, tread_speeds: FloatArray) -> FloatArray:
        """See `KinematicModel.speed_jacobian`."""
        matrix = _speed_matrix(values[..., :3]) * values[..., None, 3:]
        stack = np.broadcast_shapes(matrix.shape[:-2], np.shape(tread_speeds)[:-1])
        return np.asarray(np.broadcast_to(matrix, (*stack, 3, 2)))


def _speed_matrix(icrs: FloatArray) -> FloatArray:
    """The matrix (..., 3, 2) of Baril 2020 eq. 7."""
    y_left, y_right, x_icr = np.moveaxis(np.asarray(icrs), -1, 0)
    one = np.ones_like(y_left)
    rows = [
        np.stack([-y_right, y_left], axis=-1),
        np.stack([x_icr, -x_icr], axis=-1),
        np.stack([-one, one], axis=-1),
    ]
    return np.asarray(np.stack(rows, axis=-2) / (y_left - y_right)[..., None, None])
