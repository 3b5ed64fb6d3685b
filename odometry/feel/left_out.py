"""Scores of terrains by models that do not know them: each is left out in turn."""

from collections.abc import Iterator

import numpy as np

from odometry.arrays import BoolArray, IntArray
from odometry.feel.evidence import Calibration, Stretches
from odometry.feel.held_out import HeldOut, by_length, names_of, scored
from odometry.feel.members import Choice
from odometry.feel.scores import class_weights
from odometry.feel.strangeness import (
    LENGTHS,
    Strangeness,
    Unseen,
    farness,
    fitted_weights,
    modest_share,
    terms,
)
from odometry.feel.table import FeelTable


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
    share = max(modest_share(of, weights[length]) for length, of in parts.items())
    return Strangeness(weights, share)


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
