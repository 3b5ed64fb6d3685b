"""What a model predicts over windows, and its derivative by the parameters."""

import numpy as np

from odometry.arrays import FloatArray
from odometry.geometry import se2
from odometry.geometry.levelled import level_step_jacobian, level_steps
from odometry.models.base import KinematicModel
from odometry.models.inputs import Inputs
from odometry.windows.windows import Windows


def window_motion(model: KinematicModel, values: FloatArray, windows: Windows) -> FloatArray:
    """Predicted pose (K, 3) at the end of each window in the level frame of its start.

    Every step is the exact arc of the twist in force, seen in the level frame (Martinez 2024
    eq. 12 with REP-103's rotation); yaw is not wrapped.
    """
    twists = model.twist(values, windows.inputs)
    return _between(level_path(twists, windows.steps_s, windows.inputs), windows)


def level_path(twists: FloatArray, steps_s: FloatArray, inputs: Inputs) -> FloatArray:
    """Poses (N, 3) before each sample, from the origin in the level frame; yaw is not wrapped.

    Parameters
    ----------
    twists : (N, 3)
    steps_s : (N,)
        How long each is in force.
    inputs : Inputs
        Of stack (N,); its roll and pitch count.
    """
    return _paths(_level(se2.exp(twists * steps_s[:, None]), inputs))


def window_motion_jacobian(
    model: KinematicModel, values: FloatArray, windows: Windows
) -> FloatArray:
    """Derivative (K, 3, P) of `window_motion` by the parameters."""
    displacements = model.twist(values, windows.inputs) * windows.steps_s[:, None]
    arcs = se2.exp(displacements)
    path = _paths(_level(arcs, windows.inputs))
    by_arc = _rotations(path[:, 2]) @ _level_jacobian(arcs, windows.inputs)
    by_twist = by_arc @ se2.exp_jacobian(displacements) * windows.steps_s[:, None, None]
    by_step = _product(by_twist, model.parameter_jacobian(values, windows.inputs))
    yaw_by = _before(by_step[2])
    dx, dy = np.diff(path[:, :2], axis=0, append=path[-1:, :2]).T
    by_step[0] -= dy * yaw_by  # a turn before a step swings the step
    by_step[1] += dx * yaw_by
    sums = np.stack([_before(by_step[0]), _before(by_step[1]), yaw_by])  # (3, P, N)

    first, last = windows.first, windows.last
    on_the_way = np.moveaxis(sums[..., last] - sums[..., first], -1, 0)
    derivative = _rotations(-path[first, 2]) @ on_the_way
    end, turned = _between(path, windows), yaw_by[:, first].T
    derivative[:, 0] += end[:, 1, None] * turned  # and one before the window its frame
    derivative[:, 1] -= end[:, 0, None] * turned
    return np.asarray(derivative)


def _level(arcs: FloatArray, inputs: Inputs) -> FloatArray:
    return arcs if inputs.tilt is None else level_steps(arcs, inputs.tilt)


def _level_jacobian(arcs: FloatArray, inputs: Inputs) -> FloatArray:
    return np.eye(3) if inputs.tilt is None else level_step_jacobian(arcs, inputs.tilt)


def _product(matrices: FloatArray, jacobian: FloatArray) -> FloatArray:
    """Products of (N, 3, 3) and (N, 3, P) as (3, P, N): sums along N are then fast."""
    columns = np.ascontiguousarray(np.moveaxis(jacobian, 0, -1))
    rows = np.ascontiguousarray(np.moveaxis(matrices, 0, -1))
    return np.asarray(
        rows[:, 0, None] * columns[0]
        + rows[:, 1, None] * columns[1]
        + rows[:, 2, None] * columns[2]
    )


def _paths(steps: FloatArray) -> FloatArray:
    """Poses (N, 3) before each level step (N, 3), all steps laid end to end."""
    yaw = _before(steps[:, 2])
    cosine, sine = np.cos(yaw), np.sin(yaw)
    x = _before(cosine * steps[:, 0] - sine * steps[:, 1])
    y = _before(sine * steps[:, 0] + cosine * steps[:, 1])
    return np.column_stack([x, y, yaw])


def _rotations(yaw: FloatArray) -> FloatArray:
    """Matrices (N, 3, 3) that turn x and y by yaw (N,) and keep the heading."""
    turned = np.zeros((len(yaw), 3, 3))
    turned[:, 0, 0] = turned[:, 1, 1] = np.cos(yaw)
    turned[:, 1, 0] = np.sin(yaw)
    turned[:, 0, 1] = -turned[:, 1, 0]
    turned[:, 2, 2] = 1.0
    return turned


def _between(path: FloatArray, windows: Windows) -> FloatArray:
    start, difference = path[windows.first], path[windows.last] - path[windows.first]
    cosine, sine = np.cos(start[:, 2]), np.sin(start[:, 2])
    x = cosine * difference[:, 0] + sine * difference[:, 1]
    y = -sine * difference[:, 0] + cosine * difference[:, 1]
    return np.column_stack([x, y, difference[:, 2]])


def _before(steps: FloatArray) -> FloatArray:
    """Sum of all steps (..., N) before each one."""
    sums = np.empty_like(steps)
    sums[..., :1] = 0.0
    np.cumsum(steps[..., :-1], axis=-1, out=sums[..., 1:])
    return sums
