"""Discriminants of several layouts of bands and sets of features: their evidence is averaged."""

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from odometry.arrays import BoolArray, FloatArray
from odometry.feel.design import SHAPE, SPECTRAL, Design
from odometry.feel.discriminant import Discriminant, Pooled, fitted_discriminant, pooled
from odometry.feel.motion_features import SPEED_NAMES
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
    """Vibration with its shape, alone and with each other group: one that misleads is outvoted."""
    base = tuple(one for one in groups if one in (*SPECTRAL, SHAPE))
    others = [one for one in groups if one not in base]
    return (*([base] if base else []), *((*base, one) for one in others))


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

    def distances(self, tables: Sequence[FloatArray]) -> tuple[FloatArray, FloatArray]:
        """Squared Mahalanobis distances (W, K) to each class, the means over discriminants.

        In all columns, and within the space of the K - 1 discriminants.
        """
        whole, within = [], []
        for one, table, usual in zip(self.discriminants, tables, self.usual, strict=True):
            left = one.left(np.where(np.isfinite(table), table, usual))
            whole.append((left**2).sum(axis=2))
            within.append(((left @ one.between.T) ** 2).sum(axis=2))
        return np.asarray(np.mean(whole, axis=0)), np.asarray(np.mean(within, axis=0))

    @property
    def columns(self) -> float:
        """Mean number of columns."""
        return float(np.mean([one.means.shape[1] for one in self.discriminants]))


def pools_of(table: FeelTable, runs: BoolArray, names: tuple[str, ...]) -> tuple[Pooled, ...]:
    """Moments of windows of some of the runs (R,), one a layout."""
    return tuple(pooled(of.where(runs[of.runs]), names) for of in table.moments)


def fitted_members(table: FeelTable, pools: Sequence[Pooled], choice: Choice) -> Members:
    """Fit to the windows of `pools_of` the same table."""
    parts = [
        pools[layout].columns([*places, *_covariates(table.tables[layout])])
        for layout, places in choice.parts(table.design)
    ]
    return Members(
        tuple(fitted_discriminant(one, table.covariates, choice.shrinkage) for one in parts),
        tuple(one.usual for one in parts),
    )


def columns_of(tables: Sequence[FloatArray], design: Design, choice: Choice) -> list[FloatArray]:
    """The columns of each discriminant and the covariates (W, d + q), from one table a layout."""
    return [
        tables[layout][:, [*places, *_covariates(tables[layout])]]
        for layout, places in choice.parts(design)
    ]


def _covariates(table: FloatArray) -> range:
    return range(table.shape[1] - len(SPEED_NAMES), table.shape[1])
