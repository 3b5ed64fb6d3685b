"""How the residuals of windows answer to small changes of values, to first order."""

from collections.abc import Callable, Sequence

import numpy as np

from odometry.arrays import FloatArray
from odometry.effects.interface.base_model import Base
from odometry.effects.interface.corrected import Added
from odometry.gap.prepare.responses import Responses, whiten, whitened
from odometry.gap.prepare.simulate import rows_of_gyroscope, rows_of_poses
from odometry.windows.dense.dense import DenseWindows

Model = tuple[Base, tuple[Added, ...]]
At = Callable[[FloatArray], Model]


def whitened_derivative(
    at: At,
    values: FloatArray,
    steps: FloatArray,
    scenes: Sequence[DenseWindows],
    whiteners: Sequence[FloatArray],
    *,
    more: int = 0,
) -> FloatArray:
    """Derivative (R, V) of `whitened_residuals` by values (V,), over steps (V,); 0: not taken.

    With so many `more` rows of zeros, for what else is known of the values.
    """
    free = np.flatnonzero(steps)
    here = at(values)
    stepped = [at(values + step) for step in np.diag(steps)[free]]
    rows = sum(len(scene) * scene.rows_per_window for scene in scenes)
    jacobian = np.zeros((len(values), rows + more))
    taken = jacobian if len(free) == len(values) else np.empty((len(free), rows))
    begin = 0
    for scene, white in zip(scenes, whiteners, strict=True):
        columns = _of_scene(here, stepped, steps[free], scene)
        size = columns[0].size if len(columns) else 0
        whiten(white, columns, taken[:, begin : begin + size].reshape(columns.shape))
        begin += size
    if taken is not jacobian:
        jacobian[free, :rows] = taken
    return jacobian.T


def whitened_changes(
    here: Model,
    others: Sequence[tuple[Model, float]],
    scenes: Sequence[DenseWindows],
    whiteners: Sequence[FloatArray],
) -> FloatArray:
    """Derivatives (C, R) of `whitened_residuals` at a model, by steps to others, so long each."""
    stepped, steps = [one for one, _ in others], np.array([step for _, step in others])
    found = [
        whitened(white, _of_scene(here, stepped, steps, scene)).T
        for scene, white in zip(scenes, whiteners, strict=True)
    ]
    return np.concatenate(found, axis=1)


def _of_scene(
    model: Model, stepped: Sequence[Model], steps: FloatArray, scene: DenseWindows
) -> FloatArray:
    """Derivative (F, K, R) of the residuals of one scene."""
    here = Responses(*model, scene)
    columns = np.empty((len(steps), len(scene), scene.rows_per_window))
    moving = np.array([here.chain.is_moved_by(*one) for one in stepped], dtype=np.bool_)
    if moving.any():
        changes = here.chain.at_all([stepped[place] for place in np.flatnonzero(moving).tolist()])
        changes -= here.chain.twist
        changes /= steps[moving, None, None]
        columns[moving] = here.of(changes)
    for place in np.flatnonzero(~moving).tolist():
        np.divide(_by_sensors(here, model, stepped[place], scene), steps[place], out=columns[place])
    return columns


def _by_sensors(here: Responses, model: Model, other: Model, scene: DenseWindows) -> FloatArray:
    """By how much the residuals (K, R) differ where one number of the sensors is another.

    What the base states of the clock of poses does nothing to the gyroscope, and the reverse.
    """
    (base, _), (changed, _) = model, other
    of_poses = 3 * (scene.windows.shape[1] - 1)
    change = np.zeros((len(scene), scene.rows_per_window))
    if changed.gyro_latency_s == base.gyro_latency_s:
        change[:, :of_poses] = rows_of_poses(here.path, *other, scene) - here.rows_of_poses
    if changed.latency_s == base.latency_s:
        rows = rows_of_gyroscope(here.chain.twist, *other, scene)
        change[:, of_poses:] = rows - here.rows_of_turns
    return change
