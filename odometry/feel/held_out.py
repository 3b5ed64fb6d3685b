"""What windows get from discriminants that never saw their run."""

from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np

from odometry.arrays import BoolArray, FloatArray, IntArray
from odometry.feel.evidence import Calibration, Stretches, gathered, stretch_numbers
from odometry.feel.members import Choice, Members, columns_of, fitted_members, pools_of
from odometry.feel.table import FeelTable
from odometry.feel.windows import STEPS

LEAST_DISTANCE = 1e-6  # added, so that a window on a mean has a logarithm


@dataclass(frozen=True)
class Scores:
    """Of W windows.

    Attributes
    ----------
    log_likelihoods : (W, K)
    novelty : (W,)
        Squared distance to the nearest terrain by column.
    nearness : (W,)
        Log of the squared distance to the nearest terrain in the space of the discriminants.
    """

    log_likelihoods: FloatArray
    novelty: FloatArray
    nearness: FloatArray

    @classmethod
    def of(cls, members: Members, tables: Sequence[FloatArray]) -> "Scores":
        """By the columns of each discriminant."""
        squared, within = members.distances(tables)
        nearness = np.log(within.min(axis=1) + LEAST_DISTANCE)
        return cls(-squared / 2, squared.min(axis=1) / members.columns, nearness)


@dataclass(frozen=True)
class HeldOut:
    """W windows: their rows (W,) of the table, and their scores."""

    rows: IntArray
    scores: Scores

    @classmethod
    def joined(cls, parts: "Sequence[HeldOut]") -> "HeldOut":
        """Those of several folds."""
        return cls(
            np.concatenate([part.rows for part in parts]),
            Scores(
                np.concatenate([part.scores.log_likelihoods for part in parts]),
                np.concatenate([part.scores.novelty for part in parts]),
                np.concatenate([part.scores.nearness for part in parts]),
            ),
        )


def told_of(
    table: FeelTable, fitted: BoolArray, judged: BoolArray, choices: Sequence[Choice]
) -> list[HeldOut]:
    """Fit each choice to runs (R,) and judge windows of others; none where nothing is to judge.

    Windows of a terrain that the fitted runs do not hold are left out; a terrain that they do not
    hold is as improbable as the worst of the others.
    """
    names = names_of(table, fitted)
    rows = np.flatnonzero(judged[table.runs])
    rows = rows[np.isin(table.labels[rows].astype(str), names)]
    if not len(rows) or len(names) < 2:
        return []
    places, found = np.searchsorted(table.names, names), []
    for scores in scored(table, fitted, names, rows, choices):
        among = np.tile(scores.log_likelihoods.min(axis=1)[:, None], len(table.names))
        among[:, places] = scores.log_likelihoods
        found.append(HeldOut(rows, replace(scores, log_likelihoods=among)))
    return found


def scored(
    table: FeelTable,
    fitted: BoolArray,
    names: tuple[str, ...],
    rows: IntArray,
    choices: Sequence[Choice],
) -> list[Scores]:
    """Fit K terrains to runs (R,) and judge rows of the table, whatever their terrain."""
    pools, tables = pools_of(table, fitted, names), [one[rows] for one in table.tables]
    return [
        Scores.of(fitted_members(table, pools, one), columns_of(tables, table.design, one))
        for one in choices
    ]


def names_of(table: FeelTable, runs: BoolArray) -> tuple[str, ...]:
    """Terrains of some of the runs (R,)."""
    return tuple(sorted(set(table.labels[runs[table.runs]].tolist())))


def held_out(
    table: FeelTable, folds: IntArray, known: BoolArray, choices: Sequence[Choice]
) -> list[HeldOut]:
    """Hold out each fold (R,) of the `known` runs (R,) in turn; one a choice."""
    parts = [
        told_of(table, known & (folds != fold), known & (folds == fold), choices)
        for fold in np.unique(folds[known])
    ]
    return [HeldOut.joined(of) for of in zip(*(part for part in parts if part), strict=True)]


def windows_alone(table: FeelTable, told: HeldOut, calibration: Calibration) -> Stretches:
    """Each window by itself."""
    return Stretches(
        table.labels[told.rows],
        table.runs[told.rows],
        np.ones(len(told.rows)),
        calibration.evidence(told.scores.log_likelihoods),
        told.scores.novelty,
        told.scores.nearness,
    )


def put_together(
    table: FeelTable, told: HeldOut, calibration: Calibration, stretch_s: float
) -> Stretches:
    """Windows by stretches; with `stretch_s` infinite, by run and terrain."""
    windows = windows_alone(table, told, calibration)
    begins_s = table.begins_s[told.rows]
    parts = stretch_numbers(begins_s, windows.runs, windows.labels, stretch_s)
    return gathered(windows, parts, STEPS)
