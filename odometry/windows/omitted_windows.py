"""Why windows that a recording could have had were left out."""

from collections import Counter
from collections.abc import Iterable

import numpy as np

from odometry.arrays import AnyArray, IntArray

CHANGE_OF_TERRAIN = "change of terrain"
CHANGE_OF_WINDOW = "change of `window`"
FEW_POSES = "fewer poses than most windows"
ODOMETRY_GAP = "gap of odometry.csv"
POSE_GAP = "gap of pose.csv"
STATIONARY = "treads stationary"
UNKNOWN_TURNS = "unknown count of whole turns"


def straddling(breaks: AnyArray, first: IntArray, last: IntArray) -> Counter[str]:
    """Of windows laid without regard to breaks, how many straddle one, by the first that they do.

    Parameters
    ----------
    breaks : (M - 1,) of str
        What parts a pose from the next; empty where nothing does.
    first, last : (K,)
        Poses at the ends of each window.
    """
    places = np.flatnonzero(breaks != "")
    if not len(places):
        return Counter()
    next_break = np.searchsorted(places, first)
    inside = next_break < np.searchsorted(places, last)
    return Counter(map(str, breaks[places[next_break[inside]]]))


def summed(parts: Iterable[Counter[str]]) -> Counter[str]:
    """The counts of several runs together."""
    return sum(parts, Counter())


def words(left_out: Counter[str]) -> str:
    """One line, the most frequent reason first; empty where nothing was left out."""
    total = left_out.total()
    if not total:
        return ""
    of = ", ".join(f"{reason} ({count})" for reason, count in left_out.most_common())
    return f"{total} {'window' if total == 1 else 'windows'} left out: {of}"
