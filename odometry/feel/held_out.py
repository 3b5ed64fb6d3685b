"""What windows get from discriminants that never saw their run."""

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from odometry.arrays import BoolArray, FloatArray, IntArray
from odometry.feel.evidence import Stretches, gathered, stretch_numbers
from odometry.feel.members import Choice, Members, columns_of, fitted_members
from odometry.feel.table import FeelTable
from odometry.feel.windows import STEPS


@dataclass(frozen=True)
class HeldOut:
    """W windows.

    Attributes
    ----------
    rows : (W,)
        Of the table.
    log_likelihoods : (W, K)
    novelty : (W,)
    """

    rows: IntArray
    log_likelihoods: FloatArray
    novelty: FloatArray

    @classmethod
    def joined(cls, parts: "Sequence[HeldOut]") -> "HeldOut":
        """Those of several folds."""
        return cls(
            np.concatenate([part.rows for part in parts]),
            np.concatenate([part.log_likelihoods for part in parts]),
            np.concatenate([part.novelty for part in parts]),
        )


def scores_of(members: Members, tables: Sequence[FloatArray]) -> tuple[FloatArray, FloatArray]:
    """Log likelihoods (W, K), and novelty (W,): squared distance to the nearest by column."""
    squared = members.distances(tables)
    return -squared / 2, squared.min(axis=1) / members.columns


def told_of(
    table: FeelTable, fitted: BoolArray, judged: BoolArray, choice: Choice
) -> HeldOut | None:
    """Fit to runs (R,) and judge windows of others; None where there is nothing to judge.

    Windows of a terrain that the fitted runs do not hold are left out; a terrain that they do not
    hold is as improbable as the worst of the others.
    """
    names = tuple(sorted(set(table.labels[fitted[table.runs]].tolist())))
    rows = np.flatnonzero(judged[table.runs])
    rows = rows[np.isin(table.labels[rows].astype(str), names)]
    if not len(rows) or len(names) < 2:
        return None
    members = fitted_members(table, fitted, names, choice)
    parts = choice.parts(table.design)
    tables = columns_of([one[rows] for one in table.tables], table.covariates, parts)
    log_likelihoods, novelty = scores_of(members, tables)
    among = np.tile(log_likelihoods.min(axis=1)[:, None], len(table.names))
    among[:, np.searchsorted(table.names, names)] = log_likelihoods
    return HeldOut(rows, among, novelty)


def held_out(table: FeelTable, folds: IntArray, known: BoolArray, choice: Choice) -> HeldOut:
    """Hold out each fold (R,) of the `known` runs (R,) in turn."""
    parts = [
        told_of(table, known & (folds != fold), known & (folds == fold), choice)
        for fold in np.unique(folds[known])
    ]
    return HeldOut.joined([part for part in parts if part is not None])


def windows_alone(table: FeelTable, told: HeldOut) -> Stretches:
    """Each window by itself."""
    return Stretches(
        table.labels[told.rows],
        table.runs[told.rows],
        np.ones(len(told.rows)),
        told.log_likelihoods,
        told.novelty,
    )


def put_together(table: FeelTable, told: HeldOut, stretch_s: float) -> Stretches:
    """Windows by stretches; with `stretch_s` infinite, by run and terrain."""
    labels, runs = table.labels[told.rows], table.runs[told.rows]
    parts = stretch_numbers(table.begins_s[told.rows], runs, labels, stretch_s)
    return gathered(parts, labels, runs, (told.log_likelihoods, told.novelty), STEPS)
