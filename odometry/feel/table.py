"""All windows of all runs in one table, ready for folds."""

from collections.abc import Sequence
from dataclasses import dataclass
from functools import cached_property

import numpy as np

from odometry.arrays import AnyArray, FloatArray, IntArray
from odometry.feel.design import Design
from odometry.feel.moments import Moments, moments_of
from odometry.feel.windows import FeelWindows
from odometry.run import UNKNOWN


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
        Number of the run of each.
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
    def of(cls, windows: Sequence[FeelWindows], design: Design) -> "FeelTable":
        """Gather the windows of runs."""
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
            np.repeat(np.arange(len(windows)), counts),
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
