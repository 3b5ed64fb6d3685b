"""Poses of the reference that are no measurement, left out before anything is fitted."""

from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace

import numpy as np
from scipy.stats import binomtest, fisher_exact

from odometry.arrays import FloatArray
from odometry.effects.base_model import Base
from odometry.effects.corrected import Added
from odometry.effects.reference_outliers import FrozenPoses, ReferenceOutliers
from odometry.gap.calibration import Calibration
from odometry.gap.config import GapConfig
from odometry.gap.contest import sure_sum
from odometry.gap.frozen import frozen
from odometry.gap.isolated import Isolated, isolated
from odometry.gap.pieces import pieces
from odometry.gap.simulate import residuals
from odometry.run import Run
from odometry.windows.dense import DenseWindows

PLACES = 2  # numbers that say where a pose is


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
    measured, held_out : tuple of Isolated
        Of each run.
    """

    named: Added
    low: FloatArray
    high: FloatArray
    evidence: float
    measured: tuple[Isolated, ...]
    held_out: tuple[Isolated, ...]


def outliers_of(
    measured: Sequence[DenseWindows],
    held_out: Sequence[DenseWindows],
    known: Sequence[DenseWindows],
    calibration: Calibration,
    config: GapConfig,
) -> Outliers | None:
    """Outliers of the runs; None where the measured have no more of them than the calibration.

    By Fisher's exact test; of poses that repeat the last one, else of single ones far off.
    """
    for kind, find in KINDS:
        found, usual, others = (
            tuple(find(scene, calibration, config) for scene in of)
            for of in (measured, known, held_out)
        )
        outliers = _more_than_usual(kind, found, usual, others, config)
        if outliers is not None:
            return outliers
    return None


def _more_than_usual(
    kind: type[ReferenceOutliers],
    found: tuple[Isolated, ...],
    usual: tuple[Isolated, ...],
    others: tuple[Isolated, ...],
    config: GapConfig,
) -> Outliers | None:
    counts = [[int(one.off.sum()), int((~one.off).sum())] for one in (*found, *usual)]
    table = [np.sum(of, axis=0) for of in (counts[: len(found)], counts[len(found) :])]
    count, rest = map(int, table[0])
    chance = fisher_exact(table, alternative="greater").pvalue
    if count < config.least_outliers or chance > config.outlier_probability:
        return None
    distances_m = np.concatenate([one.distances_m[one.off] for one in found])
    squares = np.concatenate([one.sigmas[one.off] for one in found]) ** 2
    share = binomtest(count, count + rest).proportion_ci(method="wilson")
    stamps = tuple(tuple(one.stamps_s[one.off].tolist()) for one in found)
    size_m = float(np.sqrt(np.mean(distances_m**2)))
    return Outliers(
        Added(kind(stamps), np.array([count / (count + rest), size_m])),
        np.array([share.low, distances_m.min()]),
        np.array([share.high, distances_m.max()]),
        float(np.sum(squares - PLACES * np.log(count + rest))),
        found,
        others,
    )


def cleaned_runs(
    measured: Sequence[Run], held_out: Sequence[Run], outliers: Outliers
) -> tuple[list[Run], list[Run]]:
    """The runs without these poses."""
    return (
        [without(run, one) for run, one in zip(measured, outliers.measured, strict=True)],
        [without(run, one) for run, one in zip(held_out, outliers.held_out, strict=True)],
    )


def without(run: Run, found: Isolated) -> Run:
    """The run without these poses."""
    if run.pose is None:
        return run
    stamps_s = run.pose.stamps_s - run.odometry.stamps_s[0]
    kept = ~np.isin(np.round(stamps_s, 6), np.round(found.stamps_s[found.off], 6))
    return replace(run, pose=run.pose.rows(np.flatnonzero(kept)))


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
