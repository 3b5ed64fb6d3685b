"""What keeps modes from being named, and when it does."""

from dataclasses import dataclass

import numpy as np

from odometry.arrays import BoolArray
from odometry.modes.follow.followed import Followed


@dataclass(frozen=True)
class Doubt:
    """What keeps modes from being named.

    Attributes
    ----------
    reason, remedy : str
        A sentence without its full stop, and what to do.
    share : float
        Of the time.
    """

    reason: str
    remedy: str
    share: float


def share_of_time(followed: Followed, rows: BoolArray) -> float:
    """Of the time, that of the stamps `rows` (N,)."""
    lasts_s = np.append(np.diff(followed.last_track.stamps_s), 0.0)
    return float(lasts_s @ rows) / max(float(lasts_s.sum()), 1e-12)


def when(followed: Followed, rows: BoolArray) -> str:
    """From when to when the stamps `rows` (N,) are, and for how long in all."""
    begin_s, end_s = followed.last_track.stamps_s[np.flatnonzero(rows)[[0, -1]]]
    between = f"between {begin_s:.1f} s and {end_s:.1f} s"
    if (np.diff(rows.astype(int)) == 1).sum() + rows[0] == 1:
        return between
    lasts_s = np.append(np.diff(followed.last_track.stamps_s), 0.0)
    return f"for {float(lasts_s @ rows):.1f} s in all {between}"
