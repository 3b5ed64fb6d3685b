"""How fast the top of a mast moves over its foot, where a robot leans: an antenna's motion."""

import numpy as np

from odometry.arrays import FloatArray
from odometry.models.inputs import Inputs

LEANING = ("leaning_forward", "leaning_left")  # of which only a share may be added: the height


def leaning(twist: FloatArray, inputs: Inputs, axis: int) -> FloatArray | None:
    """Velocity (N,) [m/s] of a point one metre above the robot, less that of the robot.

    Along x (0) or y (1) of the robot, by R = Rz Ry(pitch) Rx(roll). Where a robot turns on one
    slope the point stays where it is over the world. None without stamps.
    """
    if inputs.time_s is None:
        return None
    off = np.stack(
        [np.cos(inputs.roll_rad) * np.sin(inputs.pitch_rad), -np.sin(inputs.roll_rad)], axis=-1
    )
    lasts_s = np.maximum(np.diff(inputs.time_s), 1e-6)
    moved = np.append(np.diff(off[:, axis]) / lasts_s, 0.0)
    turned = twist[:, 2] * off[:, 1 - axis]
    return np.asarray(moved + (turned if axis else -turned))
