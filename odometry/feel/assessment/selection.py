"""Choices of a model by held-out runs, and scores of terrains that are held out in turn."""

from collections.abc import Iterator, Sequence
from dataclasses import dataclass

import numpy as np

from odometry.arrays import AnyArray, BoolArray, IntArray
from odometry.feel.assessment.evidence import (
    Calibration,
    Stretches,
    calibrated_stretches,
    calibrated_windows,
)
from odometry.feel.assessment.held_out import (
    HeldOut,
    by_length,
    held_out,
    names_of,
    put_together,
    scored,
)
from odometry.feel.assessment.limits import STRETCH_S, Limits
from odometry.feel.assessment.scores import class_weights
from odometry.feel.classifier.members import Choice, averaged_sets
from odometry.feel.classifier.strangeness import (
    LENGTHS,
    Strangeness,
    Unseen,
    farness,
    fitted_weights,
    modest_share,
    terms,
)
from odometry.feel.classifier.table import FOLDS, FeelTable, stratified_folds


def fitted_strangeness(
    table: FeelTable,
    folds: IntArray,
    known: BoolArray,
    how: tuple[Choice, Calibration, float],
) -> Strangeness:
    """Log odds of "unknown" by terrains left out, on held-out runs (R,).

    Parameters
    ----------
    table : FeelTable
    folds : (R,)
    known : (R,)
        The runs that may be looked at.
    how : (Choice, Calibration, float)
        With the length of a stretch [s].
    """
    choice, calibration, stretch_s = how
    parts: dict[str, list[Unseen]] = {length: [] for length in LENGTHS}
    for name in names_of(table, known):
        held = _without(table, folds, known, name, choice)
        if held is None:
            continue
        for length, one in by_length(table, held, calibration, stretch_s).items():
            parts[length].append(_unseen(one, calibration, name))
    if not parts["window"]:
        return Strangeness.none()
    weights = {length: fitted_weights(of) for length, of in parts.items()}
    return Strangeness(weights, modest_share(parts, weights))


def _without(
    table: FeelTable, folds: IntArray, known: BoolArray, name: str, choice: Choice
) -> HeldOut | None:
    """All windows of the known runs, held out, by models without a terrain."""
    parts = list(_parts(table, folds, known, name, choice))
    joined = HeldOut.joined(parts) if parts else None
    labels = None if joined is None else table.labels[joined.rows]
    return joined if labels is not None and 0 < (labels == name).sum() < len(labels) else None


def _parts(
    table: FeelTable, folds: IntArray, known: BoolArray, name: str, choice: Choice
) -> Iterator[HeldOut]:
    others = tuple(one for one in names_of(table, known) if one != name)
    for fold in np.unique(folds[known]):
        fitted = known & (folds != fold)
        rows = np.flatnonzero((known & (folds == fold))[table.runs])
        if len(rows) and set(others) <= set(names_of(table, fitted)):
            yield HeldOut(rows, scored(table, fitted, others, rows, [choice])[0])


def _unseen(held: Stretches, calibration: Calibration, name: str) -> Unseen:
    is_unseen = held.labels == name
    weights = np.zeros(len(held))
    weights[is_unseen] = 0.5 / is_unseen.sum()
    weights[~is_unseen] = 0.5 * class_weights(held.labels[~is_unseen])
    sure = calibration.probabilities(held.evidence, held.windows).max(axis=1)
    return Unseen(terms(farness(held.offsets)), is_unseen, weights, sure)


SHRINKAGES = (0.03, 0.1, 0.3)
MOST_FOLDS = 60  # of runs held out one by one; more runs are dealt into so many folds


@dataclass(frozen=True)
class Judged:
    """A choice, and how well it does on windows held out.

    Attributes
    ----------
    choice : Choice
    calibration : Calibration
    window_loss, stretch_loss : float
        Log loss, with equal weights of terrains.
    held : HeldOut
    """

    choice: Choice
    calibration: Calibration
    window_loss: float
    stretch_loss: float
    held: HeldOut


@dataclass(frozen=True)
class Selected:
    """All that is chosen.

    Attributes
    ----------
    place : int
        Of the table among those that were given: the length of the windows.
    choice : Choice
    calibration : Calibration
    strangeness : Strangeness
    limits : Limits
    """

    place: int
    choice: Choice
    calibration: Calibration
    strangeness: Strangeness
    limits: Limits


def selected(
    tables: Sequence[FeelTable], groups: IntArray, known: BoolArray, rng: np.random.Generator
) -> Selected:
    """Choose the shrinkage by the log loss of windows, their length by that of stretches.

    Runs are held out one by one if they are few; so they are for calibration and limits.

    Parameters
    ----------
    tables : sequence of FeelTable
        Of the same runs, each with windows of another length.
    groups : (R,)
        Of runs that are held out together.
    known : (R,)
        The runs that may be looked at.
    rng : Generator
    """
    folds = _folds(tables[0], groups, known, MOST_FOLDS, rng)
    found = [_best(table, folds, known) for table in tables]
    place = int(np.argmin([one.stretch_loss for one in found]))
    table, best = tables[place], found[place]
    left_out = _folds(table, groups, known, FOLDS, rng)
    how = (best.choice, best.calibration, STRETCH_S)
    strangeness = fitted_strangeness(table, left_out, known, how)
    lengths = by_length(table, best.held, best.calibration, STRETCH_S)
    speeds_m_s = table.speeds_m_s[known[table.runs]]
    limits = Limits.of(lengths, speeds_m_s, table.design.window_s)
    return Selected(place, best.choice, best.calibration, strangeness, limits)


def judged(table: FeelTable, held: HeldOut, choice: Choice) -> Judged:
    """A choice with its calibration, by windows held out."""
    labels = table.labels[held.rows]
    loss, windows = calibrated_windows(held.scores.log_likelihoods, labels, table.names)
    stretches = put_together(table, held, windows, STRETCH_S)
    stretch_loss, both = calibrated_stretches(windows, stretches, table.names)
    return Judged(choice, both, loss, stretch_loss, held)


def _best(table: FeelTable, folds: IntArray, known: BoolArray) -> Judged:
    sets = averaged_sets(table.design.groups)
    choices = [Choice(sets, one) for one in SHRINKAGES]
    held = held_out(table, folds, known, choices)
    tried = [judged(table, of, one) for of, one in zip(held, choices, strict=True)]
    return min(tried, key=lambda one: one.window_loss)


def _folds(
    table: FeelTable, groups: IntArray, known: BoolArray, most: int, rng: np.random.Generator
) -> IntArray:
    """Folds (R,) of the known runs, at most so many."""
    folds = np.full(len(groups), -1)
    labels = main_labels(table, len(groups))
    count = min(most, len(np.unique(groups[known])))
    folds[known] = stratified_folds(groups[known], labels[known], count, rng)
    return folds


def main_labels(table: FeelTable, runs: int) -> AnyArray:
    """The terrain (R,) with most windows of each run; "" of a run without any."""
    labels = np.full(runs, "", dtype=object)
    for run in np.unique(table.runs):
        names, counts = np.unique(table.labels[table.runs == run].astype(str), return_counts=True)
        labels[run] = names[counts.argmax()]
    return labels
