"""How good terrain by feel is, with whole runs held out; all choices made inside the folds."""

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np

from odometry.arrays import AnyArray, FloatArray, IntArray
from odometry.feel.assessment.evidence import calibrated_windows
from odometry.feel.assessment.held_out import HeldOut, by_length, held_out, judged_runs, names_of
from odometry.feel.assessment.limits import STRETCH_S
from odometry.feel.assessment.scores import (
    balanced_accuracy,
    bootstrap_interval,
    calibration_error,
    confusion,
    error_by_chance,
    mean_excess,
)
from odometry.feel.assessment.selection import SHRINKAGES, Selected, main_labels, selected
from odometry.feel.classifier.design import CROSS, SHAPE
from odometry.feel.classifier.discriminant import fitted_discriminant, pooled
from odometry.feel.classifier.members import Choice, averaged_sets
from odometry.feel.classifier.strangeness import LENGTHS
from odometry.feel.classifier.table import FOLDS, FeelTable, stratified_folds


@dataclass(frozen=True)
class Answers:
    """Answers to windows, stretches or runs held out.

    Attributes
    ----------
    labels, runs : (N,)
    probabilities : (N, K)
    novel : (N,)
        Whether each was refused as none of the terrains.
    """

    labels: AnyArray
    runs: IntArray
    probabilities: FloatArray
    novel: AnyArray

    def right(self, names: Sequence[str]) -> AnyArray:
        """Whether the most probable terrain (N,) is the true one."""
        answers = np.array(names, dtype=object)[self.probabilities.argmax(axis=1)]
        return np.asarray(answers == self.labels)

    def to_table(self, names: Sequence[str]) -> dict[str, Any]:
        """The figures, as plain values."""
        right = self.right(names)
        answers = np.array(names, dtype=object)[self.probabilities.argmax(axis=1)]
        counts = confusion(self.labels, answers, names)
        rows = sorted(set(self.labels.tolist()))
        return {
            "answers": len(right),
            "balanced_accuracy": balanced_accuracy(self.labels, right),
            "interval": list(bootstrap_interval(self.labels, right, self.runs)),
            "calibration_error": calibration_error(self.labels, self.probabilities, names),
            "mean_excess": mean_excess(self.labels, self.probabilities, names),
            "error_by_chance": error_by_chance(
                self.labels, self.probabilities, np.arange(len(right))
            ),
            "error_by_chance_of_runs": error_by_chance(self.labels, self.probabilities, self.runs),
            "refused": 1 - balanced_accuracy(self.labels, ~self.novel),
            "confusion": {
                row: dict(zip(names, line.tolist(), strict=True))
                for row, line in zip(rows, counts, strict=True)
            },
        }


@dataclass(frozen=True)
class Assessment:
    """Answers of each length, what was chosen in each fold, and single groups of features.

    Attributes
    ----------
    names : tuple of str
    by_length : dict of str to Answers
        Of LENGTHS.
    choices : tuple of (float, Choice)
        The length of windows [s], and what was chosen for them.
    by_groups : dict of str to float
        Balanced accuracy of windows by other sets of features, nothing chosen.
    """

    names: tuple[str, ...]
    by_length: dict[str, Answers]
    choices: tuple[tuple[float, Choice], ...]
    by_groups: dict[str, float]

    def to_table(self) -> dict[str, Any]:
        """Plain values, for JSON."""
        return {
            **{name: one.to_table(self.names) for name, one in self.by_length.items()},
            "chosen_in_folds": [choice_words(*one) for one in self.choices],
            "window_by_groups": self.by_groups,
        }


def assessed(
    tables: Sequence[FeelTable], groups: IntArray, seed: int = 0, folds: int = FOLDS
) -> Assessment:
    """Nested cross-validation: groups of runs (R,) are held out, all is chosen without them.

    Parameters
    ----------
    tables : sequence of FeelTable
        Of the same runs, each with windows of another length.
    groups : (R,)
    seed : int
    folds : int
    """
    rng = np.random.default_rng(seed)
    names, labels = tables[0].names, main_labels(tables[0], len(groups))
    fold_of = stratified_folds(groups, labels, folds, rng)
    parts: dict[str, list[Answers]] = {name: [] for name in LENGTHS}
    choices = []
    for fold in np.unique(fold_of):
        known = fold_of != fold
        if len(names_of(tables[0], known)) < 2:
            continue
        best = selected(tables, groups, known, rng)
        table = tables[best.place]
        judged = judged_runs(table, known, ~known, [best.choice])
        if not judged:
            continue
        (held,) = judged
        choices.append((table.design.window_s, best.choice))
        for name, one in _answers(table, held, best).items():
            parts[name].append(one)
    joined = {name: _joined(of) for name, of in parts.items()}
    return Assessment(names, joined, tuple(choices), _by_groups(tables[0], fold_of))


def choice_words(window_s: float, choice: Choice) -> str:
    """A choice as text."""
    return f"windows of {window_s:g} s, shrinkage {choice.shrinkage:g}"


def _answers(table: FeelTable, held: HeldOut, best: Selected) -> dict[str, Answers]:
    return {
        name: Answers(
            of.labels,
            of.runs,
            best.calibration.probabilities(of.evidence, of.windows),
            best.limits.refused(of.windows, of.novelty, of.offsets),
        )
        for name, of in by_length(table, held, best.calibration, STRETCH_S).items()
    }


def _joined(parts: Sequence[Answers]) -> Answers:
    return Answers(
        np.concatenate([one.labels for one in parts]),
        np.concatenate([one.runs for one in parts]),
        np.concatenate([one.probabilities for one in parts]),
        np.concatenate([one.novel for one in parts]),
    )


def _by_groups(table: FeelTable, folds: IntArray) -> dict[str, float]:
    """Balanced accuracy of windows by each group alone, without each, by all, and by speed."""
    present = table.design.groups
    sets = {"all": present}
    if len(present) > 1:
        sets |= {f"{one} alone": (one,) for one in present if one not in (SHAPE, CROSS)}
        sets |= {f"without {one}": tuple(o for o in present if o != one) for one in present}
    everyone = np.ones(len(folds), dtype=bool)
    found = {}
    for name, groups in sets.items():
        choice = Choice(averaged_sets(groups), SHRINKAGES[0])
        (held,) = held_out(table, folds, everyone, [choice])
        labels = table.labels[held.rows]
        _, calibration = calibrated_windows(held.scores.log_likelihoods, labels, table.names)
        evidence = calibration.evidence(held.scores.log_likelihoods)
        best = np.array(table.names, dtype=object)[evidence.argmax(axis=1)]
        found[name] = balanced_accuracy(labels, best == labels)
    return found | {"speed alone": speed_alone(table, folds)}


SHRINKAGE = 0.03


def speed_alone(table: FeelTable, folds: IntArray) -> float:
    """Balanced accuracy of windows by the covariates alone, folds (R,) of runs held out."""
    width = table.tables[0].shape[1]
    places = range(width - table.covariates, width)
    covariates, moments = table.tables[0][:, list(places)], table.moments[0]
    right = np.zeros(len(table), dtype=bool)
    judged = np.zeros(len(table), dtype=bool)
    for fold in np.unique(folds):
        part = moments.where(folds[moments.runs] != fold)
        names = tuple(sorted(set(part.labels.tolist())))
        rows = (folds[table.runs] == fold) & np.isin(table.labels.astype(str), names)
        if len(names) < 2 or not rows.any():
            continue
        model = fitted_discriminant(pooled(part, names).columns(places), 0, SHRINKAGE)
        squared = (model.left(covariates[rows]) ** 2).sum(axis=2)
        right[rows] = np.array(names, dtype=object)[squared.argmin(axis=1)] == table.labels[rows]
        judged |= rows
    return balanced_accuracy(table.labels[judged], right[judged])
