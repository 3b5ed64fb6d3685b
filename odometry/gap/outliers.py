"""Poses of the reference that are far off or repeat the last, found before anything is fitted.

What the poses drift away from the treads is a slow curve, whatever effect is missing: a pose that
stands off the median of its neighbours on that curve has jumped there and back.
"""

from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace

import numpy as np
from scipy.ndimage import median_filter
from scipy.stats import binomtest, fisher_exact

from odometry.arrays import BoolArray, FloatArray
from odometry.effects.base_model import Base
from odometry.effects.corrected import Added
from odometry.effects.reference_outliers import FrozenPoses, ReferenceOutliers
from odometry.gap.config import GapConfig
from odometry.gap.contest import sure_sum
from odometry.gap.pieces import pieces
from odometry.gap.simulate import residuals, simulated_poses
from odometry.run import Run
from odometry.windows.dense import DenseWindows
from odometry.windows.robust import NORMAL

NEIGHBOURS = 7  # poses of a median: up to three off in a row do not move it
PLACES = 2  # numbers that say where a pose is
LEAST_SIGMA_M = 1e-3  # of a reference
MOVED_M = 5e-3  # less since the last pose is rest
NINE_IN_TEN = 2.146  # standard deviations within which nine in ten of normal places lie


@dataclass(frozen=True)
class Isolated:
    """Poses of one run that are no measurement of its place.

    Attributes
    ----------
    off : (M,) of bool
    distances_m : (M,)
        By which each is off.
    stamps_s : (M,)
        Run time.
    sigmas : (M,)
        The same in standard deviations of the ordinary ones.
    """

    off: BoolArray
    distances_m: FloatArray
    stamps_s: FloatArray
    sigmas: FloatArray


def isolated(scene: DenseWindows, base: Base, config: GapConfig) -> Isolated:
    """Poses that are far off their neighbours, of a run as `base` drives it."""
    distances_m, sigma_m = _off_neighbours(_drift(scene, base))
    sigmas = distances_m / sigma_m
    return Isolated(sigmas > config.outlier_sigmas, distances_m, scene.pose_s, sigmas)


def repeated(scene: DenseWindows, base: Base, config: GapConfig) -> Isolated:  # noqa: ARG001
    """Poses that are those before them to every digit, while the treads run."""
    drift = _drift(scene, base)
    same = np.append(False, (np.diff(scene.poses, axis=0) == 0).all(axis=1))
    last_new = np.maximum.accumulate(np.where(same, 0, np.arange(len(same))))
    distances_m = np.hypot(*(drift - drift[last_new]).T)
    moving = distances_m > MOVED_M
    return Isolated(
        same & moving, distances_m, scene.pose_s, distances_m / _off_neighbours(drift)[1]
    )


KINDS: tuple[tuple[type[ReferenceOutliers], Callable[..., Isolated]], ...] = (
    (FrozenPoses, repeated),
    (ReferenceOutliers, isolated),
)


def _off_neighbours(drift: FloatArray) -> tuple[FloatArray, float]:
    """Distances (M,) from the median of the neighbours [m], and their standard deviation."""
    near = [median_filter(part, NEIGHBOURS, mode="nearest") for part in drift.T]
    off = drift - np.stack(near, axis=-1)
    distances_m = np.hypot(*off.T)
    sigma_m = max(
        NORMAL * float(np.median(np.abs(off))),
        float(np.quantile(distances_m, 0.9)) / NINE_IN_TEN,
        LEAST_SIGMA_M,
    )
    return distances_m, sigma_m


def _drift(scene: DenseWindows, base: Base) -> FloatArray:
    """How far the measured places (M, 2) have gone from those of the treads, step by step."""
    reckoned = simulated_poses(base, (), scene)
    steps = np.diff(reckoned[:, 0] + 1j * reckoned[:, 1])
    steps *= np.exp(1j * (scene.poses[:-1, 2] - reckoned[:-1, 2]))
    measured = np.diff(scene.poses[:, 0] + 1j * scene.poses[:, 1])
    drift = np.concatenate([[0.0], np.cumsum(measured - steps)])
    return np.stack([drift.real, drift.imag], axis=-1)


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
    calibration: Sequence[DenseWindows],
    base: Base,
    config: GapConfig,
) -> Outliers | None:
    """Outliers of the runs; None where the measured have no more of them than the calibration.

    By Fisher's exact test; of poses that repeat the last one, else of single ones far off.
    """
    for kind, find in KINDS:
        found, usual, others = (
            tuple(find(scene, base, config) for scene in of)
            for of in (measured, calibration, held_out)
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
