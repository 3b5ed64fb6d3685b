"""Tilted terrain: the level frame that shares the yaw of a body, and the steepest slope.

The attitude is REP-103's Rz(yaw) Ry(pitch) Rx(roll) (data/README.md; Martinez 2024 eq. 12 prints
another order). A step (dx, dy, angle) lies in the body's own plane: the position part is exact,
and so is the yaw where the terrain is a plane. Steps and attitudes broadcast.
"""

from typing import NamedTuple

import numpy as np

from odometry.arrays import FloatArray, components_first, components_last
from odometry.geometry.angles import sine_and_cosine


class Tilt(NamedTuple):
    """Sines and cosines (...) of roll and pitch, less than a quarter turn each."""

    sin_roll: FloatArray
    cos_roll: FloatArray
    sin_pitch: FloatArray
    cos_pitch: FloatArray


def tilt_of(roll_rad: FloatArray, pitch_rad: FloatArray) -> Tilt:
    """Of roll and pitch (...)."""
    return Tilt(np.sin(roll_rad), np.cos(roll_rad), np.sin(pitch_rad), np.cos(pitch_rad))


def level_steps(steps: FloatArray, tilt: Tilt) -> FloatArray:
    """Horizontal part of steps on tilted terrain.

    Parameters
    ----------
    steps : (..., 3)
        dx, dy [m] in the body frame at the start of the step, angle about the body's z [rad].
    tilt : Tilt
        At the start of the step.

    Returns
    -------
    (..., 3)
        Along and across [m] in the level frame of the start's yaw, and the change of yaw [rad].
        On level terrain the steps themselves, also where they are more than half a turn.
    """
    dx, dy, angle = components_first(np.asarray(steps))
    x_turned, y_turned = _turned_axis(angle, tilt)
    change = np.arctan2(y_turned, x_turned) - angle
    change -= 2 * np.pi * np.rint(change / (2 * np.pi))  # less than half a turn
    along = tilt.cos_pitch * dx + tilt.sin_pitch * tilt.sin_roll * dy
    return components_last(np.stack([along, tilt.cos_roll * dy + 0 * along, angle + change]))


def rises(steps: FloatArray, tilt: Tilt) -> FloatArray:
    """Change of height (...) of steps (..., 3), see `level_steps`."""
    dx, dy, _ = np.moveaxis(np.asarray(steps), -1, 0)
    return np.asarray(-tilt.sin_pitch * dx + tilt.cos_pitch * tilt.sin_roll * dy)


def level_step_jacobian(steps: FloatArray, tilt: Tilt) -> FloatArray:
    """Derivative (..., 3, 3) of `level_steps` by the steps."""
    x_turned, y_turned = _turned_axis(np.asarray(steps)[..., 2], tilt)
    jacobian = np.zeros((3, 3, *x_turned.shape))
    jacobian[0, 0] = tilt.cos_pitch
    jacobian[0, 1] = tilt.sin_pitch * tilt.sin_roll
    jacobian[1, 1] = tilt.cos_roll
    jacobian[2, 2] = tilt.cos_roll * tilt.cos_pitch / (x_turned**2 + y_turned**2)
    return np.moveaxis(jacobian, (0, 1), (-2, -1))


def _turned_axis(angle: FloatArray, tilt: Tilt) -> tuple[FloatArray, FloatArray]:
    """Horizontal part of the x axis after a turn about the body's z."""
    sine, cosine = sine_and_cosine(angle)
    x = tilt.cos_pitch * cosine + tilt.sin_pitch * tilt.sin_roll * sine
    return x, tilt.cos_roll * sine


def paper_attitude(roll_rad: FloatArray, pitch_rad: FloatArray) -> tuple[FloatArray, FloatArray]:
    """Roll alpha and pitch phi of Martinez 2024: about Y forward, then X right; phi > 0 nose up.

    Exact: both rotations give the body axes the same heights. Roll and pitch (...) are REP-103's.
    """
    sine = np.cos(pitch_rad) * np.sin(roll_rad)
    cosine = np.cos(pitch_rad) * np.cos(roll_rad)
    return np.arcsin(sine), np.arctan2(-np.sin(pitch_rad), cosine)


def steepest_slope(roll_rad: FloatArray, pitch_rad: FloatArray) -> tuple[FloatArray, FloatArray]:
    """The largest slope under a robot, and where its nose points on it.

    Parameters
    ----------
    roll_rad, pitch_rad : (...)
        REP-103: roll > 0 has the right side down, pitch > 0 the nose.

    Returns
    -------
    beta_rad : (...)
        Largest slope as the paper has it: the angle from the vertical to second order (0.3 % too
        large at 10 degrees of roll and pitch).
    gamma_rad : (...)
        From straight uphill counter-clockwise to the robot's x axis, -pi to pi; NaN on level
        terrain, where no direction is uphill.

    Examples
    --------
    >>> import numpy as np
    >>> import odometry
    >>> roll_rad, pitch_rad = np.array([0.0]), np.array([-0.1])  # nose up
    >>> slope_rad, heading_rad = odometry.steepest_slope(roll_rad, pitch_rad)
    >>> print(slope_rad, abs(heading_rad))
    [0.1] [0.]
    """
    alpha, phi = paper_attitude(np.asarray(roll_rad), np.asarray(pitch_rad))
    beta = np.hypot(alpha, phi)  # eq. 3
    gamma = np.arctan2(-alpha, phi)  # eq. 1 and 2
    return beta, np.where(beta > 0, gamma, np.nan)
