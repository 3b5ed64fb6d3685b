"""Classifiers of several sets of features, whose evidence is put together."""

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from odometry.arrays import BoolArray, FloatArray
from odometry.feel.classifier.design import CROSS, SHAPE, SPECTRAL, Design
from odometry.feel.classifier.discriminant import (
    Discriminant,
    Pooled,
    fitted_discriminant,
    fitted_to_means,
    pooled,
)
from odometry.feel.classifier.logistic import Logistic, fitted_logistic
from odometry.feel.classifier.table import FeelTable
from odometry.feel.recorded.motion_features import SPEED_NAMES

SHRINKAGE_OF_RUNS = 0.1  # of correlations of run means, of which there are few; 0.3 did the same


@dataclass(frozen=True)
class Choice:
    """Which classifiers there are.

    Attributes
    ----------
    sets : tuple of tuple of str
        Groups of features, one discriminant a set and layout of bands.
    shrinkage : float
        Of the discriminants.
    logistic : bool
        Whether a logistic regression is beside them; files of older versions hold none.
    """

    sets: tuple[tuple[str, ...], ...]
    shrinkage: float
    logistic: bool = True

    def parts(self, design: Design) -> list[tuple[int, list[int]]]:
        """The layout of each classifier, and where its columns stand in that layout.

        The logistic regression is the last, with all groups but CROSS.
        """
        found = []
        for groups in self.sets:
            small = design.only(groups)
            layouts = range(len(design.layouts)) if small.axes else range(1)
            found += [(layout, design.places(small, layout)) for layout in layouts]
        if self.logistic:
            some = {group for groups in self.sets for group in groups} - {CROSS}
            found.append((0, design.places(design.only(tuple(some)), 0)))
        return found

    def columns(self, tables: Sequence[FloatArray], design: Design) -> list[FloatArray]:
        """Columns and covariates (W, d + q) of each classifier, from one table a layout."""
        return [
            tables[layout][:, [*places, *_covariates(tables[layout].shape[1])]]
            for layout, places in self.parts(design)
        ]


def averaged_sets(groups: Sequence[str]) -> tuple[tuple[str, ...], ...]:
    """Vibration, alone and with each other group: one that misleads is outvoted."""
    base = tuple(one for one in groups if one in (*SPECTRAL, SHAPE, CROSS))
    others = [one for one in groups if one not in base]
    return (*([base] if base else []), *((*base, one) for one in others))


@dataclass(frozen=True)
class Members:
    """Classifiers of the same K classes.

    Attributes
    ----------
    discriminants : tuple of Discriminant
    usual : tuple of (d + q,)
        What stands for a number that is missing in a window, one a classifier.
    logistic : Logistic or None
    of_runs : Discriminant or None
        Of the columns of the logistic regression, whitened as the means of runs differ on one
        terrain: along columns in which these hardly differ, another terrain shows first. Files of
        older versions hold none.
    """

    discriminants: tuple[Discriminant, ...]
    usual: tuple[FloatArray, ...]
    logistic: Logistic | None = None
    of_runs: Discriminant | None = None

    def offsets(self, tables: Sequence[FloatArray]) -> tuple[FloatArray, FloatArray]:
        """How far windows are from each class, in standard deviations of a new run's window.

        Returns
        -------
        (W, K), (W, K, C)
            Squared distance in all columns, the mean over discriminants, and the offset in the
            spaces of all discriminants, and in the columns of `of_runs`, one beside the other: the
            sum of the squares of an offset is the mean over discriminants of the squared distance
            plus the mean over the columns of `of_runs`.
        """
        whole, within = [], []
        for one, table, usual in zip(self.discriminants, tables, self.usual, strict=False):
            left = one.left(filled(table, usual))
            whole.append((left**2).sum(axis=2))
            within.append(left @ one.between.T)
        joined = [np.concatenate(within, axis=2) / np.sqrt(len(within))]
        if self.of_runs is not None:
            left = self.of_runs.left(filled(tables[-1], self.usual[-1]))
            joined.append(left / np.sqrt(left.shape[2]))
        return np.asarray(np.mean(whole, axis=0)), np.concatenate(joined, axis=2)

    def log_likelihoods(self, squared: FloatArray, tables: Sequence[FloatArray]) -> FloatArray:
        """Of W windows by each kind of classifier (W, F, K), with their distances (W, K)."""
        found = [-squared / 2]
        if self.logistic is not None:
            found.append(self.logistic.log_likelihoods(filled(tables[-1], self.usual[-1])))
        return np.stack(found, axis=1)

    @property
    def columns(self) -> float:
        """Mean number of columns of a discriminant."""
        return float(np.mean([one.means.shape[1] for one in self.discriminants]))


def filled(table: FloatArray, usual: FloatArray) -> FloatArray:
    """A table (W, D) with usual numbers (D,) for NaN."""
    return np.where(np.isfinite(table), table, usual)


def fitted_members(
    table: FeelTable, runs: BoolArray, names: tuple[str, ...], choices: Sequence[Choice]
) -> list[Members]:
    """Fit each choice to the windows of K terrains in some of the runs (R,).

    A logistic regression is fitted once for all choices that differ in shrinkage alone.
    """
    pools = [pooled(of.where(runs[of.runs]), names) for of in table.moments]
    regressions, found = dict[object, Logistic](), []
    for choice in choices:
        of = [
            pools[layout].columns([*places, *_covariates(table.tables[layout].shape[1])])
            for layout, places in choice.parts(table.design)
        ]
        if choice.logistic and choice.sets not in regressions:
            regressions[choice.sets] = _regression(table, runs, names, choice, of[-1])
        discriminants = tuple(
            fitted_discriminant(one, table.covariates, choice.shrinkage)
            for one in of[: len(of) - choice.logistic]
        )
        usual = tuple(one.usual for one in of)
        if not choice.logistic:
            found.append(Members(discriminants, usual))
            continue
        of_runs = fitted_to_means(of[-1], table.covariates, SHRINKAGE_OF_RUNS)
        found.append(Members(discriminants, usual, regressions[choice.sets], of_runs))
    return found


def _regression(
    table: FeelTable, runs: BoolArray, names: tuple[str, ...], choice: Choice, of: Pooled
) -> Logistic:
    """Every terrain has the same weight, and so has every run of a terrain."""
    rows = np.flatnonzero(runs[table.runs] & np.isin(table.labels.astype(str), names))
    codes = np.searchsorted(names, table.labels[rows].astype(str))
    parts = np.unique(np.column_stack([codes, table.runs[rows]]), axis=0, return_inverse=True)
    terrain, part = parts[0][:, 0], parts[1].ravel()
    shares = 1 / (np.bincount(part) * np.bincount(terrain)[terrain] * len(names))
    columns = choice.columns([one[rows] for one in table.tables], table.design)[-1]
    columns = filled(columns, of.usual)
    return fitted_logistic(columns, codes, shares[part], of, table.covariates)


def _covariates(width: int) -> range:
    return range(width - len(SPEED_NAMES), width)
