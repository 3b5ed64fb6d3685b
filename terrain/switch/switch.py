"""The terrain in force: that of the labelled places under the footprint."""

import math
from collections.abc import Mapping
from dataclasses import dataclass, field, replace

import numpy as np

from odometry.arrays import BoolArray, FloatArray, IntArray
from odometry.config import require, require_positive
from odometry.geometry import se2
from odometry.recording.run import UNKNOWN
from odometry.recording.run_terrains import Footing
from terrain.switch.label_chain import carried
from terrain.switch.place_beliefs import LEAST, PlaceBeliefs, by_evidence, by_rows
from terrain.switch.place_labels import DRIFT, Footprint, PlaceLabel, nearest

MAJORITY = 0.5  # of the footprint; a terrain with more comes into force
KNOWN = 0.9  # a terrain that is less probable has no support


@dataclass(frozen=True)
class SwitchConfig:
    """Settings of the switch.

    Attributes
    ----------
    labels_in_row : int
        So many equal labels one after another make a change (Chen 2023: 2). With 0 the
        probabilities of all labels along the way are accumulated instead.
    on_arrival : bool
        A label counts when the footprint passes over the place it was read from; otherwise at
        once.
    by_shares : bool
        A robot astride an edge has shares of both terrains; otherwise the terrain changes in one
        step (Chen 2023) where most of the footprint is over.
    unknown_m : float
        After so much wheel travel on which the labels did not support the terrain in force, that
        of the start included, it counts as unknown [m]; used where labels are accumulated.
    label_accuracy : float
        Probability that the label of a region is right; used where labels are accumulated.
    change_m : float
        Mean distance between changes of terrain [m]; used where labels are accumulated.
    alike_m : float
        Correlation length of labels: terrain that is similar to another one is so for this
        far in the mean [m]; used where labels are accumulated.
    """

    labels_in_row: int = 0
    on_arrival: bool = True
    by_shares: bool = True
    unknown_m: float = 2.0
    label_accuracy: float = 0.9
    change_m: float = 10.0
    alike_m: float = 0.2

    def __post_init__(self) -> None:
        require(
            self.labels_in_row >= 0, f"labels_in_row = {self.labels_in_row}, expected 0 or more"
        )
        require(
            0 < self.label_accuracy < 1,
            f"label_accuracy = {self.label_accuracy}, expected between 0 and 1",
        )
        require_positive(self, "change_m", "unknown_m", "alike_m")


@dataclass(frozen=True)
class SwitchEvent:
    """A terrain that came into force.

    Attributes
    ----------
    terrain : str
    stamp_s : float
    first_label : PlaceLabel
        The first of the labels that made the change.
    waited_s, waited_m : float
        Time and wheel travel from that label to the switch.
    """

    terrain: str
    stamp_s: float
    first_label: PlaceLabel
    waited_s: float
    waited_m: float


@dataclass(frozen=True)
class Switch:
    """The terrain in force and the labelled places; every method gives a new one.

    Attributes
    ----------
    in_force : str
        `unknown` at a start of which nothing is known.
    footprint : Footprint
    config : SwitchConfig
    before : str
        The terrain before the first of `place_labels`; by default `in_force`.
    place_labels : tuple of PlaceLabel
        In order of time, as far back as the odometer knows their places.
    place_beliefs : PlaceBeliefs or None
        The terrain at the place of each label.
    shares : Mapping of str to float
        Of the terrains under the footprint, `unknown` among them; they add up to 1.
    supported_m : float
        Wheel travel where last the terrain in force was probably the one under the middle of the
        footprint; minus infinity where that is probably none with a name.
    unsupported_m : float
        Wheel travel since then.
    event : SwitchEvent or None
        What the latest call of `at` brought into force.
    """

    in_force: str
    footprint: Footprint
    config: SwitchConfig = SwitchConfig()
    before: str = ""
    place_labels: tuple[PlaceLabel, ...] = ()
    place_beliefs: PlaceBeliefs | None = None
    shares: Mapping[str, float] = field(default_factory=dict)
    supported_m: float = 0.0
    unsupported_m: float = 0.0
    event: SwitchEvent | None = None

    @property
    def footing(self) -> Footing:
        """The terrain under the robot.

        `unknown` on one that probably has no name, and where for long no label supports the one in
        force.
        """
        if self.unsupported_m > self.config.unknown_m and not self.config.labels_in_row:
            return Footing.of(UNKNOWN)
        if not self.config.by_shares:
            return Footing.of(self.in_force)
        shares = dict(self.shares)
        shares[self.in_force] = shares.get(self.in_force, 0.0) + shares.pop(UNKNOWN, 0.0)
        return Footing(self.in_force, {name: share for name, share in shares.items() if share > 0})

    def add_label(self, place_label: PlaceLabel) -> "Switch":
        """Add a label, and compute again the terrain of each place."""
        oldest_m = place_label.travel_m - self.footprint.radius_m / DRIFT
        kept = tuple(known for known in self.place_labels if known.travel_m >= oldest_m)
        before = self._before(oldest_m)
        place_labels = (*kept, place_label)
        beliefs = self._settle(place_labels, before)
        return replace(self, before=before, place_labels=place_labels, place_beliefs=beliefs)

    def without_labels(self) -> "Switch":
        """The switch after a stretch of unknown motion: no labelled place is known any more."""
        return replace(self, before=UNKNOWN, place_labels=(), place_beliefs=None)

    def at(self, stamp_s: float, pose: FloatArray, travel_m: float) -> "Switch":
        """The switch with the robot at a pose (3,) of the odometry frame."""
        if self.place_beliefs is None or not self.place_beliefs.place_labels:
            return replace(
                self,
                shares={self.in_force: 1.0},
                unsupported_m=travel_m - self.supported_m,
                event=None,
            )
        place, apart_m = self._under(self.place_beliefs, pose, travel_m)
        beliefs = carried(
            self.place_beliefs.beliefs[place], np.exp(-apart_m / self.config.change_m)[:, None]
        )
        reached = apart_m <= self.footprint.radius_m
        shares = self._shares(self.place_beliefs, beliefs[1:], reached[1:])
        terrain, event = max(shares, key=lambda name: shares[name]), None
        if reached[0] and terrain not in (self.in_force, UNKNOWN) and shares[terrain] > MAJORITY:
            place_label = self.place_beliefs.first_label(int(place[0]), terrain)
            event = SwitchEvent(
                terrain,
                stamp_s,
                place_label,
                stamp_s - place_label.stamp_s,
                travel_m - place_label.travel_m,
            )
        in_force = terrain if event is not None else self.in_force
        supported_m = self.supported_m
        if reached[0] and beliefs[0, -1] > LEAST:
            supported_m = -math.inf
        elif self._supports(self.place_beliefs, int(place[0]), beliefs[0], in_force):
            supported_m = travel_m
        return replace(
            self,
            in_force=in_force,
            shares=shares,
            supported_m=supported_m,
            unsupported_m=travel_m - supported_m,
            event=event,
        )

    def _supports(
        self, place_beliefs: PlaceBeliefs, place: int, belief: FloatArray, in_force: str
    ) -> bool:
        """Whether a named place makes the terrain before or now in force probable at the middle."""
        known = (place_beliefs.probability(belief, name) for name in (self.in_force, in_force))
        return place_beliefs.place_labels[place].label != UNKNOWN and max(known) >= KNOWN

    def _shares(
        self, place_beliefs: PlaceBeliefs, beliefs: FloatArray, reached: BoolArray
    ) -> dict[str, float]:
        """Of the terrains at points of beliefs (m, k + 1); the one in force where not reached."""
        counts = np.bincount(
            place_beliefs.probable(beliefs[reached]), minlength=len(place_beliefs.names)
        )
        shares = dict(zip(place_beliefs.names, (counts / len(beliefs)).tolist(), strict=True))
        rest = 1 - np.count_nonzero(reached) / len(reached)
        shares[self.in_force] = shares.get(self.in_force, 0.0) + rest
        return {name: share for name, share in shares.items() if share > 0}

    def _under(
        self, place_beliefs: PlaceBeliefs, pose: FloatArray, travel_m: float
    ) -> tuple[IntArray, FloatArray]:
        """The place at the middle and at points of the footprint, and its distance [m].

        If labels count at once the last place, at the middle and at one point for all.
        """
        if not self.config.on_arrival:
            return np.full(2, len(place_beliefs.place_labels) - 1), np.zeros(2)
        points = se2.transform(pose, self.footprint.middle_and_points)
        return nearest(points, place_beliefs.places, travel_m - place_beliefs.travel_m)

    def _before(self, oldest_m: float) -> str:
        """The terrain at the last of the places that are forgotten."""
        if self.place_beliefs is None:
            return self.before or self.in_force
        place_beliefs = self.place_beliefs
        forgotten = place_beliefs.probable(place_beliefs.beliefs[place_beliefs.travel_m < oldest_m])
        names = [
            place_beliefs.names[code] for code in forgotten if place_beliefs.names[code] != UNKNOWN
        ]
        return names[-1] if names else self.before

    def _settle(self, place_labels: tuple[PlaceLabel, ...], before: str) -> PlaceBeliefs:
        c = self.config
        if c.labels_in_row:
            return by_rows(place_labels, before, c.labels_in_row)
        return by_evidence(
            place_labels,
            before,
            accuracy=c.label_accuracy,
            change_m=c.change_m,
            alike_m=c.alike_m,
        )
