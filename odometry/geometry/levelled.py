"""Steps of a body on tilted ground, seen in the level frame that shares its yaw.

The attitude is REP-103's Rz(yaw) Ry(pitch) Rx(roll) (CONVENTIONS; Martinez 2024 eq. 12 prints
another order). A step (dx, dy, angle) lies in the body's own plane: the position part is exact,
and so is the yaw where the ground is a plane. Steps and attitudes broadcast.
"""

import numpy as np

from odometry.arrays import FloatArray


def level_steps(steps: FloatArray, roll_rad: FloatArray, pitch_rad: FloatArray) -> FloatArray:
    """Horizontal part of steps on tilted ground.

    Parameters
    ----------
    steps : (..., 3)
        dx, dy [m] in the body frame at the start of the step, angle about the body's z [rad].
    roll_rad, pitch_rad : (...)
        Attitude at the start of the step, less than a quarter turn each.

    Returns
    -------
    (..., 3)
        Along and across [m] in the level frame of the start's yaw, and the change of yaw [rad].
        On level ground the steps themselves, also where they are more than half a turn.
    """
    dx, dy, angle, roll, pitch = _parts(steps, roll_rad, pitch_rad)
    # First two columns of Ry(pitch) Rx(roll), for the position and for the turned x axis.
    sine, cosine, tilt = np.sin(angle), np.cos(angle), np.sin(pitch) * np.sin(roll)
    yaw = np.arctan2(np.cos(roll) * sine, np.cos(pitch) * cosine + tilt * sine)
    change = np.mod(yaw - angle + np.pi, 2 * np.pi) - np.pi  # less than half a turn
    along = np.cos(pitch) * dx + tilt * dy
    return np.stack([along, np.cos(roll) * dy, angle + change], axis=-1)


def rises(steps: FloatArray, roll_rad: FloatArray, pitch_rad: FloatArray) -> FloatArray:
    """Change of height (...) of steps (..., 3), see `level_steps`."""
    dx, dy, _, roll, pitch = _parts(steps, roll_rad, pitch_rad)
    return np.asarray(-np.sin(pitch) * dx + np.cos(pitch) * np.sin(roll) * dy)


def level_step_jacobian(
    steps: FloatArray, roll_rad: FloatArray, pitch_rad: FloatArray
) -> FloatArray:
    """Derivative (..., 3, 3) of `level_steps` by the steps."""
    _, _, angle, roll, pitch = _parts(steps, roll_rad, pitch_rad)
    sine, cosine, tilt = np.sin(angle), np.cos(angle), np.sin(pitch) * np.sin(roll)
    x, y = np.cos(pitch) * cosine + tilt * sine, np.cos(roll) * sine
    jacobian = np.zeros((*angle.shape, 3, 3))
    jacobian[..., 0, 0] = np.cos(pitch)
    jacobian[..., 0, 1] = tilt
    jacobian[..., 1, 1] = np.cos(roll)
    jacobian[..., 2, 2] = np.cos(roll) * np.cos(pitch) / (x**2 + y**2)
    return jacobian


def _parts(
    steps: FloatArray, roll_rad: FloatArray, pitch_rad: FloatArray
) -> tuple[FloatArray, ...]:
    """dx, dy, angle, roll and pitch, all of one shape."""
    return np.broadcast_arrays(*np.moveaxis(np.asarray(steps), -1, 0), roll_rad, pitch_rad)
