"""Steps of the reference on a held-out run, which has a moment and a size of its own."""

from collections.abc import Sequence

import numpy as np

from odometry.arrays import FloatArray
from odometry.effects.interface.base_model import Base
from odometry.effects.interface.corrected import Added, corrected_twist
from odometry.effects.measurement.pose_stamps import breaks_s
from odometry.effects.measurement.reference_step import OF_EACH, ReferenceStep
from odometry.gap.prepare.simulate import path_of, poses_on
from odometry.windows.dense.dense import DenseWindows, off_measured

ROUNDS = 3  # of linearising a size


def with_step_of_run(
    base: Base, effects: Sequence[Added], place: int, scene: DenseWindows
) -> list[Added]:
    """The effects, of which one has a step in one run more, where that closes most; or none."""
    added = effects[place]
    if not isinstance(added.effect, ReferenceStep):
        return list(effects)
    begins_s, ends_s = scene.pose_s[scene.windows[:, [0, -1]]].T
    span = float(ends_s.min()), float(begins_s.max())
    effect = added.effect.with_run(span)
    size, moment = effect.parameters[-OF_EACH:]
    path = path_of(corrected_twist(base, effects, scene.inputs), scene)
    start = added.values[::OF_EACH][np.argmax(np.abs(added.values[::OF_EACH]))]

    def at(own: FloatArray) -> list[Added]:
        return [
            *effects[:place],
            Added(effect, np.append(added.values, own)),
            *effects[place + 1 :],
        ]

    def rows(own: FloatArray) -> FloatArray:
        return off_measured(poses_on(path, base, at(own), scene), scene)[:, -1, :2].ravel()

    best = np.array([0.0, moment.high])
    least = float(np.sum(rows(best) ** 2))
    for moment_s in breaks_s(scene.pose_s):
        own = np.array([start, moment_s])
        for _ in range(ROUNDS if span[0] <= moment_s <= span[1] else 0):
            here = rows(own)
            by_size = (rows(own + np.array([size.scale, 0.0])) - here) / size.scale
            moved = own[0] - by_size @ here / max(float(by_size @ by_size), np.finfo(float).tiny)
            own = np.array([np.clip(moved, size.low, size.high), moment_s])
        loss = float(np.sum(rows(own) ** 2))
        if loss < least:
            best, least = own, loss
    return at(best)
