"""Discriminants of several layouts of bands and sets of features: their evidence is averaged."""

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from odometry.arrays import BoolArray, FloatArray
from odometry.feel.design import SPECTRAL, Design
from odometry.feel.discriminant import Discriminant, fitted_discriminant
from odometry.feel.table import FeelTable


@dataclass(frozen=True)
class Choice:
    """Which discriminants there are.

    Attributes
    ----------
    sets : tuple of tuple of str
        Groups of features, one discriminant a set and layout of bands.
    shrinkage : float
    """

    sets: tuple[tuple[str, ...], ...]
    shrinkage: float

    def parts(self, design: Design) -> list[tuple[int, list[int]]]:
        """The layout of each discriminant, and where its columns stand in that layout."""
        found = []
        for groups in self.sets:
            small = design.only(groups)
            layouts = range(len(design.layouts)) if small.axes else range(1)
            found += [(layout, design.places(small, layout)) for layout in layouts]
        return found


def averaged_sets(groups: Sequence[str]) -> tuple[tuple[str, ...], ...]:
    """Vibration alone, and with each other group: one that misleads is outvoted."""
    base = tuple(one for one in groups if one in SPECTRAL)
    others = [one for one in groups if one not in SPECTRAL]
    sets = [base] if base else []
    return (*sets, *((*base, one) for one in others))


@dataclass(frozen=True)
class Members:
    """Discriminants of the same classes.

    Attributes
    ----------
    discriminants : tuple of Discriminant
    usual : tuple of (d + q,)
        What stands for a number that is missing in a window, one a discriminant.
    """

    discriminants: tuple[Discriminant, ...]
    usual: tuple[FloatArray, ...]

    def distances(self, tables: Sequence[FloatArray]) -> FloatArray:
        """Squared Mahalanobis distance (W, K) to each class, the mean over discriminants."""
        squared = [
            (one.left(np.where(np.isfinite(table), table, usual)) ** 2).sum(axis=2)
            for one, table, usual in zip(self.discriminants, tables, self.usual, strict=True)
        ]
        return np.asarray(np.mean(squared, axis=0))

    @property
    def columns(self) -> float:
        """Mean number of columns."""
        return float(np.mean([one.means.shape[1] for one in self.discriminants]))


def fitted_members(
    table: FeelTable, runs: BoolArray, names: tuple[str, ...], choice: Choice
) -> Members:
    """Fit to the windows of some of the runs (R,)."""
    discriminants, usual = [], []
    for layout, places in choice.parts(table.design):
        moments = table.moments[layout]
        rows = [*places, *_covariates(table.tables[layout], table.covariates)]
        part = moments.where(runs[moments.runs]).columns(rows)
        discriminants.append(fitted_discriminant(part, names, table.covariates, choice.shrinkage))
        usual.append(part.means.mean(axis=0))
    return Members(tuple(discriminants), tuple(usual))


def columns_of(
    tables: Sequence[FloatArray], covariates: int, parts: Sequence[tuple[int, list[int]]]
) -> list[FloatArray]:
    """The columns of each discriminant and the covariates (W, d + q), from one table a layout."""
    return [
        tables[layout][:, [*places, *_covariates(tables[layout], covariates)]]
        for layout, places in parts
    ]


def _covariates(table: FloatArray, covariates: int) -> range:
    return range(table.shape[1] - covariates, table.shape[1])
