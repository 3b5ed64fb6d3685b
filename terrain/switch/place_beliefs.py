"""The terrain at every labelled place, by all labels: by rows of equal ones, or by evidence."""

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Self

import numpy as np

from odometry.arrays import FloatArray, IntArray
from odometry.recording.run import UNKNOWN
from terrain.switch.label_chain import given_to, of_any_place, smoothed
from terrain.switch.place_labels import PlaceLabel, along_way

# a terrain less probable is not known; one label does not reach it against what was there before
LEAST = 2 / 3


@dataclass(frozen=True, eq=False)
class PlaceBeliefs:
    """Probabilities of the labelled places.

    Attributes
    ----------
    place_labels : tuple of PlaceLabel, length n
        Those whose label is a terrain, in order of time or along the way.
    names : tuple of str, length k + 1
        The known terrains, and `unknown` for one that is none of them.
    beliefs : (n, k + 1)
        Probability of each terrain at each place.
    places : (n, 2)
    travel_m : (n,)
        Wheel travel when each place was labelled.
    """

    place_labels: tuple[PlaceLabel, ...]
    names: tuple[str, ...]
    beliefs: FloatArray
    places: FloatArray
    travel_m: FloatArray

    @classmethod
    def of(
        cls, place_labels: tuple[PlaceLabel, ...], names: tuple[str, ...], beliefs: FloatArray
    ) -> Self:
        """With the places of the labels."""
        places = np.array([place_label.place for place_label in place_labels]).reshape(-1, 2)
        return cls(
            place_labels, names, beliefs, places, np.array([s.travel_m for s in place_labels])
        )

    def probable(self, beliefs: FloatArray) -> IntArray:
        """Columns (m,) of the terrains that beliefs (m, k + 1) make probable; else the last."""
        best: IntArray = beliefs.argmax(axis=1)
        best[np.maximum.reduce(beliefs, axis=1, initial=0.0) <= LEAST] = len(self.names) - 1
        return best

    def probability(self, belief: FloatArray, terrain: str) -> float:
        """Of a terrain in probabilities (k + 1,)."""
        return float(belief[self.names.index(terrain)]) if terrain in self.names else 0.0

    def first_label(self, place: int, terrain: str) -> PlaceLabel:
        """The first label of a terrain from its edge before a place on, else the last before."""
        same = self.probable(self.beliefs[: place + 1]) == self.names.index(terrain)
        first = int(np.flatnonzero(~same).max(initial=-1)) + 1
        nearest_first = (*self.place_labels[first:], *self.place_labels[:first][::-1])
        said = (place_label for place_label in nearest_first if place_label.label == terrain)
        return next(said, self.place_labels[place])


def by_rows(place_labels: Sequence[PlaceLabel], before: str, needed: int) -> PlaceBeliefs:
    """Each place has the terrain of `terrains_by_rows`, for certain."""
    terrains = terrains_by_rows([place_label.label for place_label in place_labels], before, needed)
    labelled = [
        place for place, place_label in enumerate(place_labels) if place_label.label != UNKNOWN
    ]
    names = _names(place_labels, before)
    beliefs = np.zeros((len(labelled), len(names)))
    for row, place in zip(beliefs, labelled, strict=True):
        row[names.index(terrains[place])] = 1.0
    return PlaceBeliefs.of(tuple(place_labels[place] for place in labelled), names, beliefs)


def by_evidence(
    place_labels: Sequence[PlaceLabel],
    before: str,
    *,
    accuracy: float,
    change_m: float,
    alike_m: float,
) -> PlaceBeliefs:
    """Each place has the probabilities of a chain along the way.

    An `unknown` that is evidence makes a terrain without a name more probable.

    Parameters
    ----------
    place_labels : sequence of PlaceLabel
    before : str
        The terrain under the robot when the first of these was labelled; `unknown` is any.
    accuracy, change_m, alike_m : float
        See `label_chain`.
    """
    labelled = tuple(place_label for place_label in place_labels if place_label.is_evidence)
    names = _names(place_labels, before)
    if not labelled or names == (UNKNOWN,):
        return PlaceBeliefs.of((), names, np.empty((0, len(names))))
    count = len(names) - 1
    places = np.array([place_label.place for place_label in labelled])
    order = along_way(places, alike_m)
    labelled = tuple(labelled[place] for place in order)
    between_m = np.linalg.norm(np.diff(places[order], axis=0), axis=1)
    given = given_to(
        [place_label.label for place_label in labelled],
        [place_label.probabilities for place_label in labelled],
        names[:-1],
    )
    beliefs = smoothed(
        given,
        np.concatenate([[labelled[0].distance_ahead_m], between_m]),
        of_any_place(count) if before == UNKNOWN else np.eye(count + 1)[names.index(before)],
        accuracy=accuracy,
        change_m=change_m,
        alike_m=alike_m,
        by_feel=np.array([place_label.by_feel for place_label in labelled]),
    )
    return PlaceBeliefs.of(labelled, names, beliefs)


def _names(place_labels: Sequence[PlaceLabel], before: str) -> tuple[str, ...]:
    seen = [
        name
        for place_label in place_labels
        for name in (place_label.label, *place_label.probabilities)
    ]
    known = [name for name in dict.fromkeys([before, *seen]) if name != UNKNOWN]
    return (*known, UNKNOWN)


def terrains_by_rows(labels: Sequence[str], initial: str, needed: int) -> list[str]:
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
    place_beliefs: list[str] = []
    terrain, row = initial, 0
    for place, label in enumerate(labels):
        if label == UNKNOWN:
            place_beliefs.append(UNKNOWN)
            row = 0
            continue
        row = row + 1 if place and labels[place - 1] == label else 1
        place_beliefs.append(terrain)
        if row >= needed and label != terrain:
            terrain = label
            place_beliefs[-needed:] = [label] * needed
    return place_beliefs
