"""How good terrain by feel is, with whole runs held out; all choices made inside the folds."""

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np

from odometry.arrays import AnyArray, FloatArray, IntArray
from odometry.feel.folds import FOLDS, stratified_folds
from odometry.feel.held_out import (
    HeldOut,
    held_out,
    put_together,
    told_of,
    windows_alone,
)
from odometry.feel.members import Choice, averaged_sets
from odometry.feel.model import Limits
from odometry.feel.scores import (
    balanced_accuracy,
    bootstrap_interval,
    calibration_error,
    confusion,
)
from odometry.feel.selection import SHRINKAGES, STRETCH_S, Selected, main_labels, selected
from odometry.feel.speed_alone import speed_alone
from odometry.feel.table import FeelTable

LENGTHS = ("window", "stretch", "run")


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
        told = np.array(names, dtype=object)[self.probabilities.argmax(axis=1)]
        return np.asarray(told == self.labels)

    def to_table(self, names: Sequence[str]) -> dict[str, Any]:
        """The figures, as plain values."""
        right = self.right(names)
        told = np.array(names, dtype=object)[self.probabilities.argmax(axis=1)]
        counts = confusion(self.labels, told, names)
        rows = sorted(set(self.labels.tolist()))
        return {
            "answers": len(right),
            "balanced_accuracy": balanced_accuracy(self.labels, right),
            "interval": list(bootstrap_interval(self.labels, right, self.runs)),
            "calibration_error": calibration_error(self.labels, self.probabilities, names),
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
    choices : tuple of Choice
    by_groups : dict of str to float
        Balanced accuracy of windows by other sets of features, at one shrinkage.
    """

    names: tuple[str, ...]
    by_length: dict[str, Answers]
    choices: tuple[Choice, ...]
    by_groups: dict[str, float]

    def to_table(self) -> dict[str, Any]:
        """Plain values, for JSON."""
        return {
            **{name: one.to_table(self.names) for name, one in self.by_length.items()},
            "shrinkage_of_folds": [one.shrinkage for one in self.choices],
            "window_by_groups": self.by_groups,
        }


def assessed(table: FeelTable, groups: IntArray, seed: int = 0, folds: int = FOLDS) -> Assessment:
    """Nested cross-validation: groups of runs (R,) are held out, features chosen without them."""
    rng = np.random.default_rng(seed)
    fold_of = stratified_folds(groups, main_labels(table, len(groups)), folds, rng)
    parts: dict[str, list[Answers]] = {name: [] for name in LENGTHS}
    choices = []
    for fold in np.unique(fold_of):
        known = fold_of != fold
        if len(set(table.labels[known[table.runs]].tolist())) < 2:
            continue
        best = selected(table, groups, known, rng)
        told = told_of(table, known, ~known, best.choice)
        if told is None:
            continue
        choices.append(best.choice)
        for name, one in _answers(table, told, best).items():
            parts[name].append(one)
    joined = {name: _joined(of) for name, of in parts.items()}
    return Assessment(table.names, joined, tuple(choices), _by_groups(table, fold_of))


def _answers(table: FeelTable, told: HeldOut, best: Selected) -> dict[str, Answers]:
    limits = Limits.of(best.windows, best.stretches, table.speeds_m_s)
    lengths = (
        (windows_alone(table, told), limits.window),
        (put_together(table, told, STRETCH_S), limits.stretch),
        (put_together(table, told, np.inf), limits.stretch),
    )
    return {
        name: Answers(
            of.labels,
            of.runs,
            best.calibration.probabilities(of.log_likelihoods, of.windows),
            of.novelty > limit,
        )
        for name, (of, limit) in zip(LENGTHS, lengths, strict=True)
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
        sets |= {f"{one} alone": (one,) for one in present}
        sets |= {f"without {one}": tuple(o for o in present if o != one) for one in present}
    everyone = np.ones(len(folds), dtype=bool)
    found = {}
    for name, groups in sets.items():
        sets_of = averaged_sets(groups)
        told = windows_alone(
            table, held_out(table, folds, everyone, Choice(sets_of, SHRINKAGES[0]))
        )
        best = np.array(table.names, dtype=object)[told.log_likelihoods.argmax(axis=1)]
        found[name] = balanced_accuracy(told.labels, best == told.labels)
    return found | {"speed alone": speed_alone(table, folds)}
