"""Folds of whole runs, or of whole days where they are known."""

from collections.abc import Sequence
from datetime import UTC, datetime

import numpy as np

from odometry.arrays import AnyArray, IntArray
from odometry.run import Run

FOLDS = 5
FIRST_EPOCH_S = 946_684_800.0  # the year 2000: later stamps are those of a clock


def days_of(runs: Sequence[Run]) -> tuple[str, ...] | None:
    """The day (UTC) of each run by its stamps; None where a run's stamps are not of a clock."""
    begins_s = [run.began_s for run in runs]
    if min(begins_s) < FIRST_EPOCH_S or max(begins_s) > 3 * FIRST_EPOCH_S:
        return None
    return tuple(datetime.fromtimestamp(one, UTC).date().isoformat() for one in begins_s)


def fold_groups(labels: Sequence[str], days: Sequence[str] | None) -> IntArray:
    """Which runs (R,) are held out together: those of a day, where each terrain has two days."""
    if days is not None:
        pairs = set(zip(labels, days, strict=True))
        if all(sum(name == one for one, _ in pairs) >= 2 for name in set(labels)):
            return np.unique(days, return_inverse=True)[1]
    return np.arange(len(labels))


def stratified_folds(
    groups: IntArray, labels: AnyArray, folds: int, rng: np.random.Generator
) -> IntArray:
    """The fold (R,) of each run: groups whole, each terrain spread evenly.

    Parameters
    ----------
    groups : (R,)
    labels : (R,) of str
        The terrain of each run; of a group of several, the most frequent one counts.
    folds : int
    rng : Generator
    """
    numbers = np.unique(groups)
    main = {int(group): _most_frequent(labels[groups == group].astype(str)) for group in numbers}
    fold, dealt = {}, 0
    for name in sorted(set(main.values())):
        of = [group for group in main if main[group] == name]
        for group in rng.permutation(of):
            fold[int(group)] = dealt % folds
            dealt += 1
    return np.array([fold[int(group)] for group in groups])


def _most_frequent(labels: AnyArray) -> str:
    names, counts = np.unique(labels, return_counts=True)
    return str(names[counts.argmax()])
