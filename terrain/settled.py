"""The terrain at every labelled place, by all labels: by rows of equal ones, or by evidence."""

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Self

import numpy as np

from odometry.arrays import FloatArray, IntArray
from odometry.run import UNKNOWN
from terrain.label_chain import given_to, smoothed
from terrain.label_rows import settled_by_rows
from terrain.places import Sight, along_way

LEAST = 2 / 3  # a terrain less probable is not known; one look of a place does not reach it


@dataclass(frozen=True, eq=False)
class Settled:
    """What is believed of the labelled places.

    Attributes
    ----------
    sights : tuple of Sight, length n
        Those whose label is a terrain, as they were seen or along the way.
    names : tuple of str, length k + 1
        The known terrains, and `unknown` for one that is none of them.
    beliefs : (n, k + 1)
        Probability of each terrain at each place.
    places : (n, 2)
    travel_m : (n,)
        Wheel travel at which each place was seen.
    """

    sights: tuple[Sight, ...]
    names: tuple[str, ...]
    beliefs: FloatArray
    places: FloatArray
    travel_m: FloatArray

    @classmethod
    def of(cls, sights: tuple[Sight, ...], names: tuple[str, ...], beliefs: FloatArray) -> Self:
        """With the places of the sights."""
        places = np.array([sight.place for sight in sights]).reshape(-1, 2)
        return cls(sights, names, beliefs, places, np.array([s.travel_m for s in sights]))

    def probable(self, beliefs: FloatArray) -> IntArray:
        """Columns (m,) of the terrains that beliefs (m, k + 1) make probable; else the last."""
        return np.where(beliefs.max(axis=1) > LEAST, beliefs.argmax(axis=1), len(self.names) - 1)

    def probability(self, belief: FloatArray, terrain: str) -> float:
        """Of a terrain in a belief (k + 1,)."""
        return float(belief[self.names.index(terrain)]) if terrain in self.names else 0.0

    def first_sight(self, place: int, terrain: str) -> Sight:
        """The first label of a terrain from its edge before a place on, else the last before."""
        same = self.probable(self.beliefs[: place + 1]) == self.names.index(terrain)
        first = int(np.flatnonzero(~same).max(initial=-1)) + 1
        nearest_first = (*self.sights[first:], *self.sights[:first][::-1])
        said = (sight for sight in nearest_first if sight.label == terrain)
        return next(said, self.sights[place])


def by_rows(sights: Sequence[Sight], before: str, needed: int) -> Settled:
    """Each place has the terrain of `settled_by_rows`, for certain."""
    terrains = settled_by_rows([sight.label for sight in sights], before, needed)
    labelled = [place for place, sight in enumerate(sights) if sight.label != UNKNOWN]
    names = _names(sights, before)
    beliefs = np.zeros((len(labelled), len(names)))
    for row, place in zip(beliefs, labelled, strict=True):
        row[names.index(terrains[place])] = 1.0
    return Settled.of(tuple(sights[place] for place in labelled), names, beliefs)


def by_evidence(
    sights: Sequence[Sight], before: str, *, accuracy: float, change_m: float, alike_m: float
) -> Settled:
    """Each place has the probabilities of a chain along the way; `unknown` is no evidence.

    Parameters
    ----------
    sights : sequence of Sight
    before : str
        The terrain where the first of these was seen from.
    accuracy, change_m, alike_m : float
        See `label_chain`.
    """
    labelled = tuple(sight for sight in sights if sight.label != UNKNOWN)
    names = _names(sights, before)
    if not labelled:
        return Settled.of((), names, np.empty((0, len(names))))
    places = np.array([sight.place for sight in labelled])
    order = along_way(places, alike_m)
    labelled = tuple(labelled[place] for place in order)
    between_m = np.linalg.norm(np.diff(places[order], axis=0), axis=1)
    given = given_to(
        [sight.label for sight in labelled],
        [sight.probabilities for sight in labelled],
        names[:-1],
    )
    beliefs = smoothed(
        given,
        np.concatenate([[labelled[0].distance_ahead_m], between_m]),
        np.eye(len(names))[names.index(before)],
        accuracy=accuracy,
        change_m=change_m,
        alike_m=alike_m,
        felt=np.array([sight.is_felt for sight in labelled]),
    )
    return Settled.of(labelled, names, beliefs)


def _names(sights: Sequence[Sight], before: str) -> tuple[str, ...]:
    seen = [name for sight in sights for name in (sight.label, *sight.probabilities)]
    known = [name for name in dict.fromkeys([before, *seen]) if name != UNKNOWN]
    return (*known, UNKNOWN)
