"""Poses of the reference that are no measurement, left out before anything is fitted."""

from collections.abc import Callable, Sequence
from dataclasses import dataclass

import numpy as np
from scipy.stats import binomtest, fisher_exact

from odometry.arrays import FloatArray
from odometry.effects.interface.base_model import Base
from odometry.effects.interface.corrected import Added
from odometry.effects.measurement.reference_outliers import (
    FrozenPoses,
    JumpingPoses,
    ReferenceOutliers,
)
from odometry.gap.config import GapConfig
from odometry.gap.prepare.calibration import Calibration
from odometry.gap.prepare.frozen import Isolated, frozen, isolated
from odometry.gap.prepare.jumps import Jumps, jumps
from odometry.gap.prepare.pieces import pieces
from odometry.gap.prepare.simulate import residuals
from odometry.gap.prepare.statistic import sure_sum
from odometry.windows.dense.dense import DenseWindows

PLACES = 2  # numbers of a position
MOST_UNDONE = 0.5  # share of steps that jump: where more lead to single poses, these are the fault


KINDS: tuple[tuple[type[ReferenceOutliers], Callable[..., Isolated]], ...] = (
    (FrozenPoses, frozen),
    (ReferenceOutliers, isolated),
)


@dataclass(frozen=True)
class Outliers:
    """Poses of measured and held-out runs that are no measurement.

    Attributes
    ----------
    named : Added
        How many there are on the measured runs, how far off, and when.
    low, high : (2,)
        95 % interval of the share (Wilson's); of the distance the least and the largest.
    evidence : float
        Chi-squared of these poses by the spread of the others, less the penalty for each.
    measured, held_out : tuple of Isolated or Jumps
        Of each run.
    """

    named: Added
    low: FloatArray
    high: FloatArray
    evidence: float
    measured: tuple[Isolated | Jumps, ...]
    held_out: tuple[Isolated | Jumps, ...]


def outliers_of(
    measured: Sequence[DenseWindows],
    held_out: Sequence[DenseWindows],
    known: Sequence[DenseWindows],
    calibration: Calibration,
    config: GapConfig,
) -> Outliers | None:
    """Outliers of the runs; None where the measured have no more of them than the calibration.

    By Fisher's exact test; of poses that repeat the last one, else of single ones far off. Else
    jumps that no robot makes; where most of these lead to such poses or back from them, the poses.
    """
    kinds = []
    for kind, find in KINDS:
        found, usual, others = (
            tuple(find(scene, calibration, config) for scene in of)
            for of in (measured, known, held_out)
        )
        if _more_than_usual(found, usual, config):
            return _single(kind, found, others)
        kinds.append((kind, found, others))
    jumped = [_jumps(of, calibration, config) for of in (measured, known, held_out)]
    jumping = _jumping(jumped[0], jumped[1], jumped[2], config)
    if jumping is None:
        return None
    for kind, found, others in kinds:
        seen = any(one.off.any() for one in found)
        if seen and _undone((*jumped[0], *jumped[2]), (*found, *others)):
            return _single(kind, found, others)
    return jumping


def _undone(jumped: Sequence[Jumps], single: Sequence[Isolated]) -> bool:
    """Whether most steps that jump lead to single poses, or back from them."""
    led = [
        bool(pose.off[first : last + 1].any())
        for one, pose in zip(jumped, single, strict=True)
        for first, last in one.ends
    ]
    return bool(np.mean(led) > MOST_UNDONE)


def _jumps(
    scenes: Sequence[DenseWindows], calibration: Calibration, config: GapConfig
) -> tuple[Jumps, ...]:
    return tuple(jumps(scene, calibration, config) for scene in scenes)


def _jumping(
    found: tuple[Jumps, ...],
    usual: tuple[Jumps, ...],
    others: tuple[Jumps, ...],
    config: GapConfig,
) -> Outliers | None:
    """Jumps, where there are several times as many of them as in the calibration runs.

    Runs that are held out count, too: a jump is one by itself.
    """
    distances_m = np.concatenate([one.distances_m for one in found])
    count, steps = _counted(found)
    of_all, all_steps = _counted((*found, *others))
    known, known_steps = _counted(usual)
    often = of_all / all_steps > config.jumping_times * (known + 0.5) / known_steps
    if not count or of_all < config.least_outliers or not often:
        return None
    if of_all / all_steps > config.most_jumping:
        return None
    squares = np.concatenate([one.sigmas for one in found]) ** 2
    share = binomtest(count, steps).proportion_ci(method="wilson")
    stamps = tuple(tuple(one.stamps_s[one.off].tolist()) for one in found)
    return Outliers(
        Added(JumpingPoses(stamps), np.array([count / steps, _size_m(distances_m)])),
        np.array([share.low, distances_m.min()]),
        np.array([share.high, distances_m.max()]),
        float(np.sum(squares - PLACES * np.log(steps))),
        found,
        others,
    )


def _counted(of: Sequence[Jumps]) -> tuple[int, int]:
    """Jumps and steps of some runs."""
    return sum(len(one.sigmas) for one in of), sum(one.steps for one in of)


def _size_m(distances_m: FloatArray) -> float:
    return float(np.sqrt(np.mean(distances_m**2)))


def _more_than_usual(
    found: tuple[Isolated, ...], usual: tuple[Isolated, ...], config: GapConfig
) -> bool:
    counts = [[int(one.off.sum()), int((~one.off).sum())] for one in (*found, *usual)]
    table = [np.sum(of, axis=0) for of in (counts[: len(found)], counts[len(found) :])]
    chance = fisher_exact(table, alternative="greater").pvalue
    return bool(table[0][0] >= config.least_outliers and chance <= config.outlier_probability)


def _single(
    kind: type[ReferenceOutliers], found: tuple[Isolated, ...], others: tuple[Isolated, ...]
) -> Outliers:
    """Such poses of measured and held-out runs, with a name."""
    count, poses = sum(int(one.off.sum()) for one in found), sum(len(one.off) for one in found)
    distances_m = np.concatenate([one.distances_m[one.off] for one in found])
    squares = np.concatenate([one.sigmas[one.off] for one in found]) ** 2
    share = binomtest(count, poses).proportion_ci(method="wilson")
    stamps = tuple(tuple(one.stamps_s[one.off].tolist()) for one in found)
    return Outliers(
        Added(kind(stamps), np.array([count / poses, _size_m(distances_m)])),
        np.array([share.low, distances_m.min()]),
        np.array([share.high, distances_m.max()]),
        float(np.sum(squares - PLACES * np.log(poses))),
        found,
        others,
    )


def closes(
    before: Sequence[DenseWindows], after: Sequence[DenseWindows], base: Base, config: GapConfig
) -> bool:
    """Whether the mean squared error of poses falls, surely, where these are left out.

    Of all poses of the windows, not of the last alone: few windows end at one that is off. Piece
    by piece of the runs: windows are cut anew.
    """
    gains = []
    for old, new in zip(before, after, strict=True):
        number = [pieces(scene, config.part_s) for scene in (old, new)]
        errors = [_mean_squares_m2(base, scene) for scene in (old, new)]
        for piece in np.intersect1d(number[0], number[1]):
            was, now = (of[n == piece].mean() for of, n in zip(errors, number, strict=True))
            gains.append(was - now)
    return sure_sum(np.array(gains), config.trimmed) > 0


def _mean_squares_m2(base: Base, scene: DenseWindows) -> FloatArray:
    """Squared error of the position (K,), the mean over the poses of each window."""
    places = residuals(base, (), scene)[..., :2]
    return np.asarray((places**2).sum(axis=-1).mean(axis=-1))
