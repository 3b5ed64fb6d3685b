"""Faults of the reference that the calibration runs have as well: not what is missing."""

from collections.abc import Sequence

import numpy as np

from odometry.arrays import FloatArray
from odometry.effects.interface.base import Effect, MeasurementEffect
from odometry.effects.interface.base_model import Base
from odometry.effects.interface.corrected import Added, delay_s
from odometry.gap.prepare.calibration import TOGETHER_S, Calibration
from odometry.gap.prepare.pieces import pieces
from odometry.gap.prepare.simulate import run_of, whitened_residuals
from odometry.gap.prepare.statistic import sure_sum
from odometry.windows.dense import DenseWindows
from odometry.windows.dense_noise import Noise, whitening

PARTS = (0.25, 0.5, 0.75, 1.0)  # of what the effect may always be: stamps are late, and uneven
BEST = 2  # stretches of the calibration runs without which it must still pay
MORE = 2.0  # times as uneven as there: the calibration runs do not have that


def in_calibration(
    effect: Effect, scenes: Sequence[DenseWindows], calibration: Calibration
) -> bool:
    """Whether a part of an effect that a reference may always have surely pays on calibration runs.

    Each stretch of these has a base identified on the others. Not where the stamps of the measured
    runs (`scenes`) are off by much more.
    """
    if not (isinstance(effect, MeasurementEffect) and effect.always and calibration.held_back):
        return False
    added = Added(effect, np.array(effect.always))
    known = [scene for _, scene in calibration.held_back]
    here, there = (max(_uneven_s(added, scene) for scene in of) for of in (scenes, known))
    if here > MORE * there:
        return False
    return any(_pays(Added(effect, share * added.values), calibration) for share in PARTS)


def _uneven_s(added: Added, scene: DenseWindows) -> float:
    return float(np.std(delay_s((added,), scene.pose_s, run_of(scene))))


def _pays(added: Added, calibration: Calibration) -> bool:
    gains = [_gains(added, base, scene, calibration.noise) for base, scene in calibration.held_back]
    return sure_sum(np.concatenate(gains), BEST) > 0


def _gains(added: Added, base: Base, scene: DenseWindows, noise: Noise) -> FloatArray:
    """Chi-squared (P,) that an effect takes off each stretch of a scene."""
    white = [whitening(scene, noise)]
    less, more = (whitened_residuals(base, of, [scene], white) ** 2 for of in ((), (added,)))
    _, piece = np.unique(pieces(scene, TOGETHER_S), return_inverse=True)
    rows = np.repeat(piece, scene.rows_per_window)
    return np.asarray(np.bincount(rows, weights=less - more), dtype=np.float64)
