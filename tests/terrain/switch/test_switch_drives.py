"""Switches on random drives with spins, reversals and returns, against where edges truly are.

The drives and their truth are those of `switch_drives`, which does not use the switch.
"""

import numpy as np
import pytest

from odometry.geometry import se2
from terrain.switch.place_labels import Footprint, PlaceLabel
from terrain.switch.switch import Switch, SwitchConfig
from tests.terrain.switch.switch_drives import FOOTPRINT_M, STEP_S, forward, random_drive

NEAR_M = 0.25
BOTH_RULES = pytest.mark.parametrize("needed", [0, 2], ids=["evidence", "rows"])


def followed(driven, config):
    """What is in force at each step, and the events as (step, event)."""
    switch = Switch(str(driven.terrains[0]), Footprint(*FOOTPRINT_M, scale=1.0), config)
    looks = {look.step: look for look in driven.looks}
    in_force, events = [], []
    for step, (pose, travel_m) in enumerate(zip(driven.odometer, driven.travel_m, strict=True)):
        if step in looks:
            switch = switch.add_label(place_label_of(looks[step], pose, travel_m))
        switch = switch.at(step * STEP_S, pose, travel_m)
        in_force.append(switch.in_force)
        events += [(step, switch.event)] if switch.event else []
    return np.array(in_force), events


def place_label_of(look, pose, travel_m):
    place = se2.transform(pose, look.place_robot)
    return PlaceLabel(look.label, look.step * STEP_S, travel_m, place, look.distance_ahead_m)


@pytest.mark.slow
@BOTH_RULES
@pytest.mark.parametrize("rear", [False, True], ids=["front", "rear"])
def test_every_switch_is_near_an_edge(needed, rear):
    """True labels; the camera sees nothing while the robot turns on the spot or drives back."""
    count = 0
    for seed in range(6):
        driven = random_drive(np.random.default_rng(seed), rear=rear, legs=4)
        _, events = followed(driven, SwitchConfig(labels_in_row=needed))
        for step, event in events:
            assert driven.edge_distance_m(step) <= NEAR_M
            assert event.terrain in terrains_about(driven, step)
        count += len(events)
    assert count > 10


@BOTH_RULES
def test_every_edge_of_a_way_ahead_is_found(needed):
    driven = random_drive(np.random.default_rng(5), manoeuvres=(forward,), legs=4)
    in_force, events = followed(driven, SwitchConfig(labels_in_row=needed))
    answered = [step for step, _ in events if driven.edge_distance_m(step) <= NEAR_M]
    assert len(driven.crossings) > 2
    assert 0 <= len(events) - len(driven.crossings) <= 1  # the drive may end just before an edge
    assert len(answered) == len(events)
    late = [driven.edge_distance_m(step) for step in np.flatnonzero(in_force != driven.terrains)]
    assert max(late) <= NEAR_M


@pytest.mark.slow
def test_labels_right_nine_times_in_ten_hardly_flicker():
    """Independent errors, and three labels in ten are unknown; two in a row flickers on these."""
    by_evidence, by_rows, by_true_labels = 0, 0, 0
    for seed in range(5):
        driven = random_drive(np.random.default_rng(seed), legs=4, accuracy=0.9, unknown=0.3)
        _, events = followed(driven, SwitchConfig())
        assert all(event.terrain in terrains_about(driven, step, 0.5) for step, event in events)
        by_evidence += len(events)
        by_rows += len(followed(driven, SwitchConfig(labels_in_row=2))[1])
        driven = random_drive(np.random.default_rng(seed), legs=4)
        by_true_labels += len(followed(driven, SwitchConfig())[1])
    assert abs(by_evidence - by_true_labels) <= 2
    assert by_rows > by_true_labels + 10


def terrains_about(driven, step, near_m=NEAR_M):
    """Names within some distance of the robot's middle."""
    along_m = driven.land.along_m(driven.poses[step, :2])
    codes = np.searchsorted(driven.land.edges_m, along_m + np.linspace(-near_m, near_m, 5))
    return {driven.land.terrains[code] for code in codes}


def test_the_odometer_of_the_drives_drifts_a_little():
    """The generator is what it says: poses and odometer part by some per cent of the way."""
    driven = random_drive(np.random.default_rng(0), legs=4)
    assert 0 < np.hypot(*(driven.poses - driven.odometer)[-1, :2]) < 0.1 * driven.travel_m[-1]
