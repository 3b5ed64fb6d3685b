"""What a model predicts over windows, and its derivative by the parameters.

Steps are laid end to end, and windows take their pieces of that path: the work is proportional
to the samples. It is done for some thousand samples at a time, whose arrays fit the cache, and
inside with the samples last, so that sums along them are fast.
"""

from typing import NamedTuple, Protocol

import numpy as np

from odometry.arrays import FloatArray, IntArray, components_first, components_last
from odometry.geometry import se2
from odometry.geometry.angles import sine_and_cosine
from odometry.geometry.tilt import Tilt, level_step_jacobian, level_steps
from odometry.models.base import KinematicModel, Linearised
from odometry.models.inputs import Inputs
from odometry.windows.travel.linear_motion import Block, blocks, linear_window_motion
from odometry.windows.travel.windows import Windows


class Moving(Protocol):
    """What predicts twists: a model, or one whose yaw something else carries."""

    def twist(self, values: FloatArray, inputs: Inputs) -> FloatArray:
        """See `KinematicModel.twist`."""

    def linearised(self, values: FloatArray, inputs: Inputs) -> Linearised:
        """See `KinematicModel.linearised`."""


def window_motion(model: Moving, values: FloatArray, windows: Windows) -> FloatArray:
    """Predicted pose (K, 3) at the end of each window in the level frame of its start.

    Every step is the exact arc of the twist in force, in the level frame (Martinez 2024
    eq. 12 with REP-103's rotation); yaw is not wrapped.
    """
    twists = model.twist(values, windows.inputs)
    path = level_path(twists, windows.steps_s, windows.inputs)
    return _between(path, windows.first, windows.last)


def level_path(twists: FloatArray, steps_s: FloatArray, inputs: Inputs) -> FloatArray:
    """Poses (..., N, 3) before each sample, from the origin in the level frame.

    Yaw is not wrapped.

    Parameters
    ----------
    twists : (..., N, 3)
    steps_s : (N,)
        How long each is in force.
    inputs : Inputs
        Of stack (N,); its roll and pitch count.
    """
    return _laid(_level(se2.quick_exp(twists * steps_s[:, None]), inputs.tilt)).poses


def linearised_level_path(
    twists: FloatArray, steps_s: FloatArray, inputs: Inputs
) -> tuple[FloatArray, FloatArray]:
    """`level_path` (N, 3), and what twists (N, 3) move of it (7, N).

    The rows are x (3) and y (3) of all later samples, turned about the origin, and yaw (by the
    turn alone).
    """
    arcs, by_arc = se2.linearised_exp(twists * steps_s[:, None])
    path = _laid(_level(arcs, inputs.tilt))
    return path.poses, steps_s * _by_displacement(path, arcs, by_arc, inputs.tilt)


def linearised_window_motion(
    model: Moving, values: FloatArray, windows: Windows
) -> tuple[FloatArray, FloatArray]:
    """`window_motion` (K, 3), to rounding, and its derivative (K, 3, P) by the parameters."""
    is_level = windows.inputs.tilt is None
    if is_level and isinstance(model, KinematicModel) and model.is_linear_in_speeds:
        return linear_window_motion(model, values, windows)
    twists, by_parameters = model.linearised(values, windows.inputs)
    columns = np.ascontiguousarray(np.moveaxis(by_parameters, 0, -1))  # (3, P, N)
    motion = np.empty((len(windows), 3))
    derivative = np.empty((len(windows), *by_parameters.shape[1:]))
    for block in blocks(windows):
        arcs, by_arc = se2.linearised_exp(twists[block.samples] * block.steps_s[:, None])
        path = _laid(_level(arcs, block.tilt))
        motion[block.windows] = _between(path.poses, block.first, block.last)
        by_twist = block.steps_s * _by_displacement(path, arcs, by_arc, block.tilt)
        for parameter in range(by_parameters.shape[-1]):
            changes = columns[:, parameter, block.samples]
            derivative[block.windows, :, parameter] = _moved(by_twist, changes, path, block)
    return motion, derivative


class _Path(NamedTuple):
    """Steps laid end to end."""

    poses: FloatArray  # (..., N, 3), before each step
    after: FloatArray  # (2, ..., N), places after each
    sine: FloatArray  # (..., N), of the yaw before each
    cosine: FloatArray


def _level(arcs: FloatArray, tilt: Tilt | None) -> FloatArray:
    return arcs if tilt is None else level_steps(arcs, tilt)


def _laid(steps: FloatArray) -> _Path:
    """The paths of level steps (..., N, 3)."""
    along, across, turns = components_first(steps)
    yaw = _summed(turns)[..., :-1]
    sine, cosine = sine_and_cosine(yaw)
    x = _summed(cosine * along - sine * across)
    y = _summed(sine * along + cosine * across)
    poses = components_last(np.stack([x[..., :-1], y[..., :-1], yaw]))
    return _Path(poses, np.stack([x[..., 1:], y[..., 1:]]), sine, cosine)


def _by_displacement(
    path: _Path, arcs: FloatArray, by_arc: FloatArray, tilt: Tilt | None
) -> FloatArray:
    """What displacements (N, 3) move: x (3), y (3) and yaw (by the turn alone) in rows (7, N).

    x and y are those of all later steps in the path's frame, turned about its origin.
    """
    along, across, turn = np.moveaxis(by_arc, 0, -1)
    yaw = turn[2]
    if tilt is not None:
        level = np.moveaxis(level_step_jacobian(arcs, tilt), 0, -1)
        along, across = level[0, 0] * along + level[0, 1] * across, level[1, 1] * across
        yaw = level[2, 2]
    x = path.cosine * along - path.sine * across
    y = path.sine * along + path.cosine * across
    x[2] += path.after[1] * yaw  # a turn swings what comes after its step
    y[2] -= path.after[0] * yaw
    return np.stack([*x, *y, yaw])


def _moved(by_twist: FloatArray, changes: FloatArray, path: _Path, block: Block) -> FloatArray:
    """Change (K, 3) of the windows' motion when the twists change (3, N)."""
    v_x, v_y, omega = changes
    x_by, y_by, yaw_by = by_twist[:3], by_twist[3:6], by_twist[6]
    x, y, yaw = (
        block.within(step)
        for step in (
            x_by[0] * v_x + x_by[1] * v_y + x_by[2] * omega,
            y_by[0] * v_x + y_by[1] * v_y + y_by[2] * omega,
            yaw_by * omega,
        )
    )
    end_x, end_y, _ = path.poses[block.last].T
    x, y = x - end_y * yaw, y + end_x * yaw
    start = path.poses[block.first, 2]
    cosine, sine = np.cos(start), np.sin(start)
    return np.stack([cosine * x + sine * y, cosine * y - sine * x, yaw], axis=-1)


def _between(path: FloatArray, first: IntArray, last: IntArray) -> FloatArray:
    start, difference = path[first], path[last] - path[first]
    cosine, sine = np.cos(start[:, 2]), np.sin(start[:, 2])
    x = cosine * difference[:, 0] + sine * difference[:, 1]
    y = -sine * difference[:, 0] + cosine * difference[:, 1]
    return np.column_stack([x, y, difference[:, 2]])


def _summed(steps: FloatArray) -> FloatArray:
    """Sums (..., N + 1) of the steps (..., N) before each one, and of all."""
    sums = np.empty((*steps.shape[:-1], steps.shape[-1] + 1))
    sums[..., 0] = 0.0
    np.cumsum(steps, axis=-1, out=sums[..., 1:])
    return sums
