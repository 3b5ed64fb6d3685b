"""Which terrain lies at each place of a row of places: so many equal labels (Chen 2023)."""

from collections.abc import Sequence

from odometry.run import UNKNOWN


def settled_by_rows(labels: Sequence[str], initial: str, needed: int) -> list[str]:
    """The terrain at each place, by labels in the order in which they were read.

    Parameters
    ----------
    labels : sequence of str
        `unknown` breaks a row and changes nothing.
    initial : str
        The terrain before the first place.
    needed : int
        So many equal labels one after another make a change, from the first of them on.

    Returns
    -------
    list of str
        `unknown` where the label is.
    """
    settled: list[str] = []
    terrain, row = initial, 0
    for place, label in enumerate(labels):
        if label == UNKNOWN:
            settled.append(UNKNOWN)
            row = 0
            continue
        row = row + 1 if place and labels[place - 1] == label else 1
        settled.append(terrain)
        if row >= needed and label != terrain:
            terrain = label
            settled[-needed:] = [label] * needed
    return settled
