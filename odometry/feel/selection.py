"""How much shrinkage, and what evidence is worth, by runs held out."""

from dataclasses import dataclass

import numpy as np

from odometry.arrays import AnyArray, BoolArray, IntArray
from odometry.feel.evidence import Calibration, Stretches, calibrated
from odometry.feel.folds import stratified_folds
from odometry.feel.held_out import held_out, put_together, windows_alone
from odometry.feel.members import Choice, averaged_sets
from odometry.feel.table import FeelTable

SHRINKAGES = (0.03, 0.1, 0.3)
STRETCH_S = 10.0
MOST_FOLDS = 60  # of runs held out one by one; more runs are dealt into so many folds


@dataclass(frozen=True)
class Selected:
    """A choice, and what its windows held out got.

    Attributes
    ----------
    choice : Choice
    loss : float
        Log loss of windows, every terrain counting alike.
    calibration : Calibration
    windows, stretches : Stretches
    """

    choice: Choice
    loss: float
    calibration: Calibration
    windows: Stretches
    stretches: Stretches


def selected(
    table: FeelTable, groups: IntArray, known: BoolArray, rng: np.random.Generator
) -> Selected:
    """The shrinkage of least log loss on windows of runs held out, one by one if they are few.

    Parameters
    ----------
    table : FeelTable
    groups : (R,)
        Of runs that are held out together.
    known : (R,)
        The runs that may be looked at.
    rng : Generator
    """
    folds = np.full(len(groups), -1)
    labels = main_labels(table, len(groups))
    count = min(MOST_FOLDS, len(np.unique(groups[known])))
    folds[known] = stratified_folds(groups[known], labels[known], count, rng)
    sets = averaged_sets(table.design.groups)
    tried = [judged(table, folds, known, Choice(sets, one)) for one in SHRINKAGES]
    return min(tried, key=lambda one: one.loss)


def judged(table: FeelTable, folds: IntArray, known: BoolArray, choice: Choice) -> Selected:
    """A choice with its calibration, by windows held out."""
    told = held_out(table, folds, known, choice)
    windows, stretches = windows_alone(table, told), put_together(table, told, STRETCH_S)
    loss, calibration = calibrated(windows, stretches, table.names)
    return Selected(choice, loss, calibration, windows, stretches)


def main_labels(table: FeelTable, runs: int) -> AnyArray:
    """The terrain (R,) with most windows of each run; "" of a run without any."""
    labels = np.full(runs, "", dtype=object)
    for run in np.unique(table.runs):
        names, counts = np.unique(table.labels[table.runs == run].astype(str), return_counts=True)
        labels[run] = names[counts.argmax()]
    return labels
