"""Rules that the switch keeps, wherever the robot goes and whatever labels it gets."""

import numpy as np
import pytest
from hypothesis import settings
from hypothesis import strategies as st
from hypothesis.stateful import RuleBasedStateMachine, invariant, precondition, rule

from terrain.switch.place_labels import DRIFT, Footprint, PlaceLabel
from terrain.switch.switch import Switch, SwitchConfig

FOOTPRINT = Footprint(0.6, 0.5)


class AnyDrive(RuleBasedStateMachine):
    """A robot that goes anywhere and gets any labels."""

    needed = 2

    def __init__(self):
        super().__init__()
        self.switch = Switch("grass", FOOTPRINT, SwitchConfig(labels_in_row=self.needed))
        self.pose, self.stamp_s, self.travel_m = np.zeros(3), 0.0, 0.0
        self.labels, self.path = [], []
        self.confirmed = {"grass"}

    @rule(
        label=st.sampled_from(["grass", "gravel", "sand", "unknown"]),
        ahead_m=st.floats(0.0, 2.0),
        repeat=st.integers(1, 3),
    )
    def add_label(self, label, ahead_m, repeat):
        heading = np.array([np.cos(self.pose[2]), np.sin(self.pose[2])])
        in_force = self.switch.in_force
        for _ in range(repeat):
            place = self.pose[:2] + ahead_m * heading
            place_label = PlaceLabel(label, self.stamp_s, self.travel_m, place, ahead_m)
            self.switch = self.switch.add_label(place_label)
            self.labels.append(label)
            if self.labels[-max(1, self.needed) :] == [label] * max(1, self.needed):
                self.confirmed.add(label)
        assert self.switch.in_force == in_force  # seeing alone changes nothing

    @rule(length_m=st.floats(0.0, 0.3), turn=st.floats(-0.5, 0.5), steps=st.integers(1, 8))
    def drive(self, length_m, turn, steps):
        for _ in range(steps):
            self.pose[2] += turn
            self.pose[:2] += length_m * np.array([np.cos(self.pose[2]), np.sin(self.pose[2])])
            self.stamp_s += 0.1
            self.travel_m += length_m
            self.path.append(self.pose[:2].copy())
            before = self.switch
            self.switch = before.at(self.stamp_s, self.pose.copy(), self.travel_m)
            self.check_event(before)

    def check_event(self, before):
        event = self.switch.event
        assert (event is not None) == (self.switch.in_force != before.in_force)
        if event is None:
            return
        assert event.terrain == self.switch.in_force
        labels = {place_label.label for place_label in self.switch.place_labels}
        assert event.first_label.label == event.terrain or event.terrain not in labels
        assert event.waited_s == pytest.approx(self.stamp_s - event.first_label.stamp_s)
        assert event.waited_m == pytest.approx(self.travel_m - event.first_label.travel_m)
        assert sum(self.switch.shares.values()) == pytest.approx(1.0)
        assert self.switch.shares[event.terrain] > 0.5
        apart_m = [
            np.hypot(*(self.pose[:2] - place_label.place))
            for place_label in self.switch.place_labels
        ]
        assert min(apart_m) <= FOOTPRINT.radius_m

    @invariant()
    def only_what_was_heard_often_enough_is_in_force(self):
        assert self.switch.in_force in self.confirmed - {"unknown"}

    @invariant()
    def no_more_is_kept_than_the_odometer_can_tell(self):
        place_labels = self.switch.place_labels
        if place_labels:
            longest_m = place_labels[-1].travel_m - place_labels[0].travel_m
            assert longest_m <= FOOTPRINT.radius_m / DRIFT + 1e-9

    @precondition(lambda self: self.travel_m > 0)
    @rule()
    def far_away_nothing_is_reached(self):
        far = self.pose + np.array([1000.0, 1000.0, 0.0])
        there = self.switch.at(self.stamp_s, far, self.travel_m + 1000.0)
        assert there.in_force == self.switch.in_force
        assert there.event is None


class AnyDriveByEvidence(AnyDrive):
    """The same with labels accumulated."""

    needed = 0


TestAnyDrive = AnyDrive.TestCase
TestAnyDriveByEvidence = AnyDriveByEvidence.TestCase
DRAWN = settings(max_examples=40, stateful_step_count=20, deadline=None)
TestAnyDrive.settings = TestAnyDriveByEvidence.settings = DRAWN
