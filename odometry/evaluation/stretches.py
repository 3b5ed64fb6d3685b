"""Stretches of a run: of one terrain, and of equal wheel travel."""

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from odometry.arrays import FloatArray, IntArray


def spatial_horizons(travel_m: FloatArray, horizon_m: float, stride_m: float) -> IntArray:
    """Windows of a given wheel travel.

    Parameters
    ----------
    travel_m : (N,)
        Wheel travel at each sample, not decreasing.
    horizon_m : float
        Wheel travel of a window.
    stride_m : float
        Wheel travel from the start of one window to the start of the next.

    Returns
    -------
    (K, 2)
        First and last sample of each window. The last is the first sample at which the wheel
        travel is reached, so that a window may be longer than `horizon_m` by one step. While
        the robot is stationary, only one window starts.
    """
    travelled = travel_m - travel_m[0]
    last = np.floor(max(travelled[-1] - horizon_m, -1.0) / stride_m + 1e-9)
    strides = np.minimum(np.floor((travelled + 1e-9) / stride_m), last)  # whole ones up to a sample
    starts = np.flatnonzero(np.diff(strides, prepend=-1.0) > 0)
    ends = np.searchsorted(travelled, travelled[starts] + horizon_m - 1e-9)
    inside = ends < len(travel_m)
    return np.unique(np.stack([starts[inside], ends[inside]], axis=-1), axis=0)


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
