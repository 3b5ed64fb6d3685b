"""Stretches of a run of one terrain."""

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from odometry.arrays import FloatArray


@dataclass(frozen=True)
class Stretch:
    """A terrain from one moment to the next change, or to the end."""

    terrain: str
    start_s: float
    end_s: float


def stretches(stamps_s: FloatArray, terrains: Sequence[str]) -> tuple[Stretch, ...]:
    """Join equal neighbours: each terrain lasts until the stamp where another one begins.

    Parameters
    ----------
    stamps_s : (N,)
    terrains : sequence of N str
        Rows with the empty name are left out: what was there before goes on.

    Returns
    -------
    tuple of Stretch
        In order of time, neighbours of different terrains; the last ends at the last stamp.

    Examples
    --------
    >>> import numpy as np
    >>> import odometry
    >>> found = odometry.stretches(np.array([0.0, 1.0, 2.0]), ["grass", "grass", "ice"])
    >>> [(stretch.terrain, stretch.end_s) for stretch in found]
    [('grass', 2.0), ('ice', 2.0)]
    """
    names = np.asarray(terrains, dtype=object)
    rows = np.flatnonzero(names != "")
    if not len(rows):
        return ()
    begins = rows[np.append(True, names[rows[1:]] != names[rows[:-1]])]
    starts_s = [float(stamp_s) for stamp_s in np.asarray(stamps_s)[begins]]
    ends_s = [*starts_s[1:], float(stamps_s[-1])]
    return tuple(
        Stretch(str(names[row]), start_s, end_s)
        for row, start_s, end_s in zip(begins, starts_s, ends_s, strict=True)
    )


def terrain_at(found: Sequence[Stretch], stamp_s: float) -> str:
    """The terrain at a moment, "" outside of all stretches."""
    for stretch in reversed(found):
        if stretch.start_s <= stamp_s <= stretch.end_s:
            return stretch.terrain
    return ""
