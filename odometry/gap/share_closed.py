"""The share of the excess gap that effects close on runs held out, with an interval."""

from dataclasses import dataclass

import numpy as np

from odometry.gap.config import GapConfig
from odometry.gap.result import GapResult
from odometry.gap.statistic import SEED, drawn_gaps, squared_errors


@dataclass(frozen=True)
class Share:
    """Of the excess above the noise floor that is closed, with a 95 % interval; 1 is all.

    `pieces` is the number of held-out stretches; of one alone there is no interval.
    """

    value: float
    low: float
    high: float
    pieces: int


def held_out_share(result: GapResult, part_s: float = GapConfig.part_s) -> Share | None:
    """By drawing pieces of the held-out runs, and of the calibration; None without an excess.

    Before and after are paired where both are of the same windows. There is no excess where the gap
    before is not above the noise floor in 97.5 % of the draws.
    """
    held, kept = result.holdout_scenes, result.calibration.held_back
    base = result.calibration.base
    raw = result.holdout_before or held
    before = np.concatenate([squared_errors(base, (), scene) for scene in raw])
    after = np.concatenate([squared_errors(result.base, result.added, scene) for scene in held])
    floor = np.concatenate([squared_errors(own, (), scene) for own, scene in kept])
    rng = np.random.default_rng(SEED)
    if raw is held:
        gaps = drawn_gaps((before, after), held, part_s, rng)
    else:
        gaps = np.concatenate(
            [drawn_gaps((of,), s, part_s, rng) for of, s in ((before, raw), (after, held))]
        )
    (floors,) = drawn_gaps((floor,), [scene for _, scene in kept], part_s, rng)
    floors *= result.holdout.noise_floor.value / np.sqrt(floor.mean())  # as it is on these runs
    excess = gaps[0] - floors
    if result.holdout.before.value <= result.holdout.noise_floor.value:
        return None
    if np.quantile(excess, 0.025) <= 0:
        return None
    low, high = np.quantile((gaps[0] - gaps[1]) / excess, [0.025, 0.975])
    return Share(result.holdout.share_closed, float(low), float(high), result.holdout.before.pieces)
