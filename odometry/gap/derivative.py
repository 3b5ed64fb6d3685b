"""Derivative of whitened residuals by the values of a base and of effects.

A value of the base or of an effect on the motion changes the twists, by differences of these
alone; what that does to residuals is exact to first order. A value of a sensor leaves the path as
it is.
"""

from collections.abc import Callable, Sequence

import numpy as np

from odometry.arrays import FloatArray
from odometry.effects.base_model import Base
from odometry.effects.corrected import Added
from odometry.gap.responses import Responses, whitened
from odometry.gap.simulate import residuals_on
from odometry.windows.dense import DenseWindows

At = Callable[[FloatArray], tuple[Base, tuple[Added, ...]]]


def whitened_derivative(
    at: At,
    values: FloatArray,
    steps: FloatArray,
    scenes: Sequence[DenseWindows],
    whiteners: Sequence[FloatArray],
) -> FloatArray:
    """Derivative (R, V) of `whitened_residuals` by values (V,), over steps (V,); 0: not taken."""
    free = np.flatnonzero(steps)
    stepped = [at(values + step) for step in np.diag(steps)[free]]
    found = []
    for scene, white in zip(scenes, whiteners, strict=True):
        here = Responses(*at(values), scene)
        columns = _of_scene(here, stepped, steps[free], at(values), scene)
        found.append(whitened(white, columns))
    jacobian = np.zeros((sum(map(len, found)), len(values)))
    jacobian[:, free] = np.concatenate(found)
    return jacobian


def _of_scene(
    here: Responses,
    stepped: Sequence[tuple[Base, tuple[Added, ...]]],
    steps: FloatArray,
    at: tuple[Base, tuple[Added, ...]],
    scene: DenseWindows,
) -> FloatArray:
    """Derivative (F, K, R) of the residuals of one scene."""
    columns = np.empty((len(steps), len(scene), scene.rows_per_window))
    moving = np.array([here.chain.is_moved_by(*one) for one in stepped], dtype=np.bool_)
    if moving.any():
        changes = [
            (here.chain.at(*stepped[place]) - here.chain.twist) / steps[place]
            for place in np.flatnonzero(moving).tolist()
        ]
        columns[moving] = here.of(np.stack(changes))
    if not moving.all():
        rows = residuals_on(here.chain.twist, here.path, *at, scene)
        for place in np.flatnonzero(~moving).tolist():
            other = residuals_on(here.chain.twist, here.path, *stepped[place], scene)
            columns[place] = (other - rows) / steps[place]
    return columns
