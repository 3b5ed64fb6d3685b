"""All windows of all runs in one table, and folds of whole runs or days."""

from collections.abc import Sequence
from dataclasses import dataclass
from datetime import UTC, datetime
from functools import cached_property

import numpy as np

from odometry.arrays import AnyArray, FloatArray, IntArray
from odometry.feel.classifier.design import Design
from odometry.feel.classifier.discriminant import Moments, moments_of
from odometry.feel.recorded.windows import FeelWindows
from odometry.recording.run import UNKNOWN, Run


@dataclass(frozen=True)
class FeelTable:
    """W windows on named terrain in which the robot moves.

    Attributes
    ----------
    design : Design
        Of all columns.
    tables : tuple of (W, d + q)
        Columns and covariates, one a layout.
    labels : (W,) of str
    runs : (W,)
        Number of the run of each, or of the drive that it is a part of.
    begins_s : (W,)
    speeds_m_s : (W,)
    """

    design: Design
    tables: tuple[FloatArray, ...]
    labels: AnyArray
    runs: IntArray
    begins_s: FloatArray
    speeds_m_s: FloatArray

    @classmethod
    def of(
        cls, windows: Sequence[FeelWindows], design: Design, numbers: IntArray | None = None
    ) -> "FeelTable":
        """Gather the windows of R runs; those with the same number (R,) count as one."""
        kept = [one.felt & (one.labels != UNKNOWN) for one in windows]
        counts = [int(of.sum()) for of in kept]
        return cls(
            design,
            tuple(
                np.concatenate(
                    [
                        np.hstack([design.matrix(one, layout), one.covariates])[of]
                        for one, of in zip(windows, kept, strict=True)
                    ]
                )
                for layout in range(len(design.layouts))
            ),
            np.concatenate([one.labels[of] for one, of in zip(windows, kept, strict=True)]),
            np.repeat(np.arange(len(windows)) if numbers is None else numbers, counts),
            np.concatenate([one.begins_s[of] for one, of in zip(windows, kept, strict=True)]),
            np.concatenate([one.speeds_m_s[of] for one, of in zip(windows, kept, strict=True)]),
        )

    def __len__(self) -> int:
        return len(self.labels)

    @property
    def names(self) -> tuple[str, ...]:
        """Terrains, in the order of the alphabet."""
        return tuple(sorted(set(self.labels.tolist())))

    @property
    def covariates(self) -> int:
        """How many of the last columns describe how a window was driven."""
        return int(self.tables[0].shape[1]) - len(self.design.names(0))

    @cached_property
    def moments(self) -> tuple[Moments, ...]:
        """By run and terrain, one a layout."""
        return tuple(moments_of(table, self.labels, self.runs) for table in self.tables)


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
