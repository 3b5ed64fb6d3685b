"""The gap: an error of position over windows, and its interval."""

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from odometry.arrays import FloatArray
from odometry.effects.base import Base
from odometry.effects.corrected import Added
from odometry.gap.scene import Scene, pieces
from odometry.gap.simulate import residuals

RESAMPLES = 1000
SEED = 0


@dataclass(frozen=True)
class Gap:
    """Root mean square [m] with a 95 % interval."""

    value: float
    low: float
    high: float


def squared_errors(base: Base, effects: Sequence[Added], scene: Scene) -> FloatArray:
    """Squared error (K,) of the position at the end of each window [m^2]."""
    ends = residuals(base, effects, scene)[:, -1, :2]
    return np.asarray((ends**2).sum(axis=-1))


def gap_of(base: Base, effects: Sequence[Added], scenes: Sequence[Scene], part_s: float) -> Gap:
    """The gap over all windows; resampled are pieces of the runs, not windows."""
    return _pooled([(squared_errors(base, effects, scene), scene) for scene in scenes], part_s)


def floor_of(held_back: Sequence[tuple[Base, Scene]], part_s: float) -> Gap:
    """The noise floor: the same over stretches of calibration runs, each with its own base."""
    return _pooled([(squared_errors(base, (), scene), scene) for base, scene in held_back], part_s)


def _pooled(errors: Sequence[tuple[FloatArray, Scene]], part_s: float) -> Gap:
    sums, counts = [], []
    for squares, scene in errors:
        _, place = np.unique(pieces(scene, part_s), return_inverse=True)
        sums.append(np.bincount(place, weights=squares))
        counts.append(np.bincount(place))
    total, number = np.concatenate(sums), np.concatenate(counts)
    rng = np.random.default_rng(SEED)
    drawn = rng.integers(len(total), size=(RESAMPLES, len(total)))
    means = total[drawn].sum(axis=1) / number[drawn].sum(axis=1)
    low, high = np.sqrt(np.quantile(means, [0.025, 0.975]))
    return Gap(float(np.sqrt(total.sum() / number.sum())), float(low), float(high))
