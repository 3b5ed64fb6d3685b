"""Effects that the calibration runs have as well: not what is missing."""

from collections.abc import Sequence

import numpy as np

from odometry.arrays import FloatArray
from odometry.effects.interface.base import Effect, MeasurementEffect
from odometry.effects.interface.base_model import Base
from odometry.effects.interface.corrected import Added, delay_s
from odometry.gap.config import GapConfig
from odometry.gap.prepare.calibration import TOGETHER_S, Calibration
from odometry.gap.prepare.pieces import pieces
from odometry.gap.prepare.simulate import run_of, whitened_residuals
from odometry.gap.prepare.statistic import sure_sum
from odometry.windows.dense.dense import DenseWindows
from odometry.windows.dense.dense_noise import Noise, whitening

PARTS = (0.25, 0.5, 0.75, 1.0)  # of what the effect may always be: stamps are late, and uneven
BEST = 2  # stretches of the calibration runs without which it must still pay
SPOILT = 0.1  # of a gain a row: best fits of right names lose 0.03, wrong ones 0.12 and more
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


def is_new(added: Added, calibration: Calibration, config: GapConfig) -> str:
    """Whether the calibration runs do not show an effect as much.

    They do where it surely pays there with the same values, and with more than half of them: it is
    part of the noise floor, as what makes wheels no constant ICRs is. What these runs hardly do, as
    to go slowly, pays by rounding alone.
    """
    if added.effect.course or not _scenes_of(added, calibration):
        return ""
    whole, half = (_all_gains(_share_of(added, share), calibration) for share in (1.0, 0.5))
    if sure_sum(whole, BEST) <= config.equivalent_margin or whole.sum() < half.sum():
        return ""
    return "the calibration runs show as much of it: it is not what is missing"


def spoils_calibration(
    added: Added, gain: float, calibration: Calibration, config: GapConfig
) -> str:
    """Whether an effect that acts in every drive makes the calibration runs worse.

    By a part of the chi-squared a row, `gain`, that it takes off the measured runs. Calibration
    runs that are driven more slowly, or on level terrain, say little of it, and lose as little.
    """
    scenes = _scenes_of(added, calibration)
    if not scenes:
        return ""
    rows = sum(len(scene) * scene.rows_per_window for scene in scenes)
    lost = -float(_all_gains(added, calibration).sum())
    if lost <= max(config.equivalent_margin, SPOILT * gain * rows):
        return ""
    return "it would act in the calibration runs as well, and these do not show it"


def _scenes_of(added: Added, calibration: Calibration) -> list[DenseWindows]:
    """The calibration runs that are held back in turn; none where one lacks what it acts on."""
    scenes = [scene for _, scene in calibration.held_back]
    lacking = any(added.effect.lacks(scene.inputs, calibration.base) for scene in scenes)
    return [] if lacking else scenes


def _share_of(added: Added, share: float) -> Added:
    """An effect with so much of what its parameters do; those that shape it stay."""
    absent = [
        value if of.absent is None else of.absent
        for of, value in zip(added.effect.parameters, added.values, strict=True)
    ]
    return Added(added.effect, absent + share * (added.values - absent))


def _uneven_s(added: Added, scene: DenseWindows) -> float:
    return float(np.std(delay_s((added,), scene.pose_s, run_of(scene))))


def _pays(added: Added, calibration: Calibration) -> bool:
    return sure_sum(_all_gains(added, calibration), BEST) > 0


def _all_gains(added: Added, calibration: Calibration) -> FloatArray:
    """Chi-squared (P,) that an effect takes off each stretch of the calibration runs."""
    pairs = calibration.held_back
    return np.concatenate([_gains(added, *pair, calibration.noise) for pair in pairs])


def _gains(added: Added, base: Base, scene: DenseWindows, noise: Noise) -> FloatArray:
    """Of one of them (P,)."""
    white = [whitening(scene, noise)]
    less, more = (whitened_residuals(base, of, [scene], white) ** 2 for of in ((), (added,)))
    _, piece = np.unique(pieces(scene, TOGETHER_S), return_inverse=True)
    rows = np.repeat(piece, scene.rows_per_window)
    return np.asarray(np.bincount(rows, weights=less - more), dtype=np.float64)
