"""The share of the excess gap that effects close on runs held out, with an interval."""

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from odometry.arrays import FloatArray
from odometry.gap.config import GapConfig
from odometry.gap.result import GapResult
from odometry.gap.scene import Scene, pieces
from odometry.gap.statistic import squared_errors

RESAMPLES = 1000
SEED = 0


@dataclass(frozen=True)
class Share:
    """Of the excess above the noise floor that is closed, with a 95 % interval; 1 is all."""

    value: float
    low: float
    high: float


def held_out_share(result: GapResult, part_s: float = GapConfig.part_s) -> Share | None:
    """By drawing pieces of the held-out runs, and of the calibration; None without an excess.

    Before and after are paired: both are of the same pieces. There is no excess where the gap
    before is not above the noise floor in 97.5 % of the draws.
    """
    held, kept = result.holdout_scenes, result.calibration.held_back
    base = result.calibration.base
    before = [squared_errors(base, (), scene) for scene in held]
    after = [squared_errors(result.base, result.added, scene) for scene in held]
    floor = [squared_errors(own, (), scene) for own, scene in kept]
    rng = np.random.default_rng(SEED)
    gaps = _drawn_rms(held, (before, after), part_s, rng)
    (floors,) = _drawn_rms([scene for _, scene in kept], (floor,), part_s, rng)
    excess = gaps[0] - floors
    if result.holdout.before.value <= result.holdout.noise_floor.value:
        return None
    if np.quantile(excess, 0.025) <= 0:
        return None
    low, high = np.quantile((gaps[0] - gaps[1]) / excess, [0.025, 0.975])
    return Share(result.holdout.share_closed, float(low), float(high))


def _drawn_rms(
    scenes: Sequence[Scene],
    errors: Sequence[Sequence[FloatArray]],
    part_s: float,
    rng: np.random.Generator,
) -> FloatArray:
    """Root mean squares (E, R) of each kind of squared errors, by the same draws of pieces."""
    places, begin = [], 0
    for scene in scenes:
        number = np.unique(pieces(scene, part_s), return_inverse=True)[1]
        places.append(begin + number)
        begin += int(number.max(initial=-1)) + 1
    place = np.concatenate(places)
    counts = np.bincount(place)
    drawn = rng.integers(len(counts), size=(RESAMPLES, len(counts)))
    sums = np.stack([np.bincount(place, weights=np.concatenate(list(of))) for of in errors])
    return np.asarray(np.sqrt(sums[:, drawn].sum(axis=-1) / counts[drawn].sum(axis=-1)))
