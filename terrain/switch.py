"""When the terrain changes: labels of places ahead become the terrain in force."""

from dataclasses import dataclass, replace

import numpy as np

from odometry.arrays import FloatArray
from odometry.config import require
from odometry.geometry import se2
from odometry.run import UNKNOWN


@dataclass(frozen=True)
class SwitchConfig:
    """Settings of the switch.

    Attributes
    ----------
    labels_in_row : int
        So many equal labels one after another make a change (Chen 2023: 2).
    on_arrival : bool
        A label counts when the robot gets to the place it was read from; otherwise at once.
    """

    labels_in_row: int = 2
    on_arrival: bool = True

    def __post_init__(self) -> None:
        require(
            self.labels_in_row >= 1, f"labels_in_row = {self.labels_in_row}, expected 1 or more"
        )


@dataclass(frozen=True)
class Sight:
    """A label and the place that it belongs to.

    Attributes
    ----------
    label : str
    stamp_s : float
        When it was seen.
    travel_m : float
        Wheel travel of the run when it was seen.
    place : (2,)
        The middle of the region in the reference frame [m]; in a `Switch`, where the label's
        terrain begins.
    distance_ahead_m : float
        Wheel travel from the robot to the place when it was seen.
    passed : bool
        Whether the robot has been at the place since.
    """

    label: str
    stamp_s: float
    travel_m: float
    place: FloatArray
    distance_ahead_m: float
    passed: bool = False


@dataclass(frozen=True)
class SwitchEvent:
    """A terrain that came into force.

    Attributes
    ----------
    terrain : str
    stamp_s : float
    sight : Sight
        The first of the labels that made the change.
    waited_s, waited_m : float
        Time and wheel travel from that sight to the switch.
    """

    terrain: str
    stamp_s: float
    sight: Sight
    waited_s: float
    waited_m: float


@dataclass(frozen=True)
class Switch:
    """The terrain in force and what lies ahead; every method gives a new one.

    Attributes
    ----------
    in_force : str
    reach_m : float
        The robot is at a place once that is no longer ahead and no farther away than this.
    config : SwitchConfig
    last : Sight or None
        The latest label that was not `unknown`.
    row : tuple of Sight
        The latest equal labels.
    waiting : tuple of Sight
        Changes ahead, in the order in which they were seen.
    event : SwitchEvent or None
        What the latest call of `at` brought into force.
    """

    in_force: str
    reach_m: float
    config: SwitchConfig = SwitchConfig()
    last: Sight | None = None
    row: tuple[Sight, ...] = ()
    waiting: tuple[Sight, ...] = ()
    event: SwitchEvent | None = None

    @property
    def ahead(self) -> str:
        """The terrain after the last change that is known to lie ahead."""
        return self.waiting[-1].label if self.waiting else self.in_force

    def see(self, sight: Sight) -> "Switch":
        """Take in a label; `unknown` breaks a row and never switches."""
        if sight.label == UNKNOWN:
            return replace(self, row=())
        same = self.row and self.row[-1].label == sight.label
        row = (*self.row, sight) if same else (self._from_edge(sight),)
        row = row[-self.config.labels_in_row :]
        seen = replace(self, last=sight, row=row)
        if len(row) < self.config.labels_in_row or sight.label == self.ahead:
            return seen
        return replace(seen, waiting=(*self.waiting, row[0]))

    def _from_edge(self, sight: Sight) -> Sight:
        """Move a first label half-way to the last place of another: the edge lies between them."""
        if self.last is None or self.last.label == sight.label:
            return sight
        edge = (self.last.place + sight.place) / 2
        if np.hypot(*(edge - sight.place)) > self.reach_m / 2:
            return sight
        return replace(sight, place=edge)

    def at(self, stamp_s: float, pose: FloatArray, travel_m: float) -> "Switch":
        """Bring into force the last change that the robot has got to, and forget missed ones."""
        row = self._followed(self.row, pose, travel_m)
        waiting = self._followed(self.waiting, pose, travel_m)
        reached = [
            place
            for place, sight in enumerate(waiting)
            if sight.passed or not self.config.on_arrival
        ]
        if not reached:
            return replace(self, row=row, waiting=waiting, event=None)
        sight, waiting = waiting[reached[-1]], waiting[reached[-1] + 1 :]
        if sight.label == self.in_force:
            return replace(self, row=row, waiting=waiting, event=None)
        event = SwitchEvent(
            sight.label, stamp_s, sight, stamp_s - sight.stamp_s, travel_m - sight.travel_m
        )
        return replace(self, in_force=sight.label, row=row, waiting=waiting, event=event)

    def _followed(
        self, sights: tuple[Sight, ...], pose: FloatArray, travel_m: float
    ) -> tuple[Sight, ...]:
        """The sights, marked where the robot is now, without those that it missed."""
        marked = (
            replace(sight, passed=True) if self._is_there(sight, pose) else sight
            for sight in sights
        )
        return tuple(s for s in marked if s.passed or not _is_missed(s, travel_m, self.reach_m))

    def _is_there(self, sight: Sight, pose: FloatArray) -> bool:
        ahead, aside = se2.transform(se2.inverse(pose), sight.place)
        return bool(ahead <= 0 and np.hypot(ahead, aside) <= self.reach_m)


def _is_missed(sight: Sight, travel_m: float, reach_m: float) -> bool:
    """Whether the robot would long be at the place if it had gone there."""
    return travel_m - sight.travel_m > 2 * sight.distance_ahead_m + reach_m
