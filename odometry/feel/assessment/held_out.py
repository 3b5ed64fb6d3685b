"""What windows get from discriminants that never saw their run."""

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from odometry.arrays import BoolArray, FloatArray, IntArray
from odometry.feel.assessment.evidence import Calibration, Stretches, gathered, stretch_numbers
from odometry.feel.classifier.members import Choice, Members, fitted_members
from odometry.feel.classifier.table import FeelTable
from odometry.feel.recorded.windows import STEPS


@dataclass(frozen=True)
class Scores:
    """Of W windows.

    Attributes
    ----------
    log_likelihoods : (W, F, K)
        By F kinds of classifiers.
    novelty : (W,)
        Squared distance to the nearest terrain by column.
    offsets : (W, K, C)
        From each terrain in the space of the discriminants, see `Members`.
    """

    log_likelihoods: FloatArray
    novelty: FloatArray
    offsets: FloatArray

    @classmethod
    def of(cls, members: Members, tables: Sequence[FloatArray]) -> "Scores":
        """By the columns of each discriminant."""
        squared, offsets = members.offsets(tables)
        likelihoods = members.log_likelihoods(squared, tables)
        return cls(likelihoods, squared.min(axis=1) / members.columns, offsets)

    def since(self, first: int) -> "Scores":
        """Those of the windows from a row on."""
        return Scores(self.log_likelihoods[first:], self.novelty[first:], self.offsets[first:])

    @classmethod
    def joined(cls, parts: "Sequence[Scores]") -> "Scores":
        """Those of several parts; zeros where one of fewer terrains has fewer directions."""
        return cls(
            np.concatenate([part.log_likelihoods for part in parts]),
            np.concatenate([part.novelty for part in parts]),
            _stacked([part.offsets for part in parts]),
        )

    def among(self, places: IntArray, count: int) -> "Scores":
        """The same among `count` terrains, of which these stand at `places`.

        The others are as improbable as the worst of these, and infinitely far.
        """
        likelihoods = np.tile(self.log_likelihoods.min(axis=2)[..., None], count)
        likelihoods[..., places] = self.log_likelihoods
        offsets = np.full((len(self.novelty), count, self.offsets.shape[2]), np.inf)
        offsets[:, places] = self.offsets
        return Scores(likelihoods, self.novelty, offsets)


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
            Scores.joined([part.scores for part in parts]),
        )


def _stacked(offsets: Sequence[FloatArray]) -> FloatArray:
    """Offsets of several folds: zeros where a fold with fewer terrains has fewer directions."""
    most = max(one.shape[2] for one in offsets)
    return np.concatenate(
        [np.pad(one, ((0, 0), (0, 0), (0, most - one.shape[2]))) for one in offsets]
    )


def judged_runs(
    table: FeelTable, fitted: BoolArray, judged: BoolArray, choices: Sequence[Choice]
) -> list[HeldOut]:
    """Fit each choice to runs (R,) and evaluate windows of others; none where there are none.

    Windows of a terrain that the fitted runs do not hold are left out.
    """
    names = names_of(table, fitted)
    rows = np.flatnonzero(judged[table.runs])
    rows = rows[np.isin(table.labels[rows].astype(str), names)]
    if not len(rows) or len(names) < 2:
        return []
    places = np.searchsorted(table.names, names)
    return [
        HeldOut(rows, scores.among(places, len(table.names)))
        for scores in scored(table, fitted, names, rows, choices)
    ]


def scored(
    table: FeelTable,
    fitted: BoolArray,
    names: tuple[str, ...],
    rows: IntArray,
    choices: Sequence[Choice],
) -> list[Scores]:
    """Fit K terrains to runs (R,) and evaluate rows of the table, of any terrain."""
    tables = [one[rows] for one in table.tables]
    members = fitted_members(table, fitted, names, choices)
    return [
        Scores.of(of, one.columns(tables, table.design))
        for of, one in zip(members, choices, strict=True)
    ]


def names_of(table: FeelTable, runs: BoolArray) -> tuple[str, ...]:
    """Terrains of some of the runs (R,)."""
    return tuple(sorted(set(table.labels[runs[table.runs]].tolist())))


def held_out(
    table: FeelTable, folds: IntArray, known: BoolArray, choices: Sequence[Choice]
) -> list[HeldOut]:
    """Hold out each fold (R,) of the `known` runs (R,) in turn; one a choice."""
    parts = [
        judged_runs(table, known & (folds != fold), known & (folds == fold), choices)
        for fold in np.unique(folds[known])
    ]
    return [HeldOut.joined(of) for of in zip(*(part for part in parts if part), strict=True)]


def windows_alone(table: FeelTable, held: HeldOut, calibration: Calibration) -> Stretches:
    """Each window by itself."""
    return Stretches(
        table.labels[held.rows],
        table.runs[held.rows],
        np.ones(len(held.rows)),
        calibration.evidence(held.scores.log_likelihoods),
        held.scores.novelty,
        held.scores.offsets,
    )


def put_together(
    table: FeelTable, held: HeldOut, calibration: Calibration, stretch_s: float
) -> Stretches:
    """Windows by stretches; with `stretch_s` infinite, by run and terrain."""
    windows = windows_alone(table, held, calibration)
    begins_s = table.begins_s[held.rows]
    parts = stretch_numbers(begins_s, windows.runs, windows.labels, stretch_s)
    return gathered(windows, parts, STEPS)


def by_length(
    table: FeelTable, held: HeldOut, calibration: Calibration, stretch_s: float
) -> dict[str, Stretches]:
    """Windows alone, by stretches, and by run, under LENGTHS."""
    return {
        "window": windows_alone(table, held, calibration),
        "stretch": put_together(table, held, calibration, stretch_s),
        "run": put_together(table, held, calibration, np.inf),
    }
