"""Rules that the switch keeps, wherever the robot goes and whatever it is told."""

import numpy as np
import pytest
from hypothesis import settings
from hypothesis import strategies as st
from hypothesis.stateful import RuleBasedStateMachine, invariant, precondition, rule

from terrain.switch import Sight, Switch, SwitchConfig

REACH_M = 0.6


class AnyDrive(RuleBasedStateMachine):
    """A robot that goes anywhere and is told anything."""

    def __init__(self):
        super().__init__()
        self.needed = 2
        self.switch = Switch("grass", REACH_M, SwitchConfig(labels_in_row=self.needed))
        self.pose, self.stamp_s, self.travel_m = np.zeros(3), 0.0, 0.0
        self.heard, self.path = [], []
        self.confirmed = {"grass"}

    @rule(
        label=st.sampled_from(["grass", "gravel", "sand", "unknown"]),
        ahead_m=st.floats(0.0, 2.0),
        repeat=st.integers(1, 3),
    )
    def see(self, label, ahead_m, repeat):
        heading = np.array([np.cos(self.pose[2]), np.sin(self.pose[2])])
        in_force = self.switch.in_force
        for _ in range(repeat):
            place = self.pose[:2] + ahead_m * heading
            sight = Sight(label, self.stamp_s, self.travel_m, place, ahead_m)
            self.switch = self.switch.see(sight)
            self.heard.append(label)
            if self.heard[-self.needed :] == [label] * self.needed:
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
        assert event.terrain == self.switch.in_force == event.sight.label
        assert event.waited_s == pytest.approx(self.stamp_s - event.sight.stamp_s)
        assert event.waited_m == pytest.approx(self.travel_m - event.sight.travel_m)
        nearest = min(np.linalg.norm(place - event.sight.place) for place in self.path)
        assert nearest <= REACH_M

    @invariant()
    def only_what_was_heard_often_enough_is_in_force(self):
        assert self.switch.in_force in self.confirmed - {"unknown"}

    @invariant()
    def what_waits_is_no_longer_than_what_was_heard(self):
        assert len(self.switch.row) <= self.needed
        assert all(sight.label != "unknown" for sight in self.switch.waiting)

    @precondition(lambda self: self.travel_m > 0)
    @rule()
    def far_away_all_is_forgotten(self):
        far = self.pose + np.array([1000.0, 1000.0, 0.0])
        assert self.switch.at(self.stamp_s, far, self.travel_m + 1000.0).waiting == ()


AnyDrive.TestCase.settings = settings(max_examples=60, stateful_step_count=20)
TestAnyDrive = AnyDrive.TestCase
