"""When a label becomes the terrain in force: by hand, and with true labels."""

import dataclasses
import math
from itertools import pairwise

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from odometry.errors import ConfigError
from terrain.switch import Sight, Switch, SwitchConfig

REACH_M = 0.6
AHEAD_M = 1.0


def start(in_force="grass", **settings_):
    return Switch(in_force, REACH_M, SwitchConfig(**settings_))


def seen_at(x, label, ahead_m=AHEAD_M, stamp_s=None):
    """A label seen by a robot at (x, 0), heading along x."""
    place = np.array([x + ahead_m, 0.0])
    return Sight(label, 2 * x if stamp_s is None else stamp_s, x, place, ahead_m)


def drive(switch, labels, spacing_m=0.25, step_m=0.05, to_m=None):
    """Drive along x at 0.5 m/s; labels[k] is seen at k * spacing_m, "" is no label.

    Returns what was in force at every step as (x, terrain), and all events.
    """
    to_m = len(labels) * spacing_m + AHEAD_M if to_m is None else to_m
    seen, history, events = 0, [], []
    for x in np.arange(0.0, to_m + 1e-9, step_m):
        if seen < len(labels) and x >= seen * spacing_m - 1e-9:
            if labels[seen]:
                switch = switch.see(seen_at(x, labels[seen]))
            seen += 1
        switch = switch.at(2 * x, np.array([x, 0.0, 0.0]), x)
        history.append((float(x), switch.in_force))
        events += [switch.event] if switch.event else []
    return history, events


def changes(history):
    """Where and to what the terrain in force changed."""
    pairs = pairwise(history)
    return [(round(x, 6), now) for (_, before), (x, now) in pairs if now != before]


def test_two_equal_labels_switch_half_way_to_the_place_of_the_first():
    """Last grass of the place at 1.25 m, first gravel, seen at 0.5 m, of that at 1.5 m."""
    history, events = drive(start(), ["grass", "grass", "gravel", "gravel", "gravel"])
    assert changes(history) == [(1.4, "gravel")]
    (event,) = events
    assert event.terrain == "gravel"
    assert event.sight.label == "gravel"
    assert event.stamp_s == pytest.approx(2.8)
    assert event.sight.stamp_s == pytest.approx(1.0)
    assert event.waited_s == pytest.approx(1.8)
    assert event.waited_m == pytest.approx(0.9)


def test_an_edge_is_not_sought_between_places_far_apart():
    """Places 1 m apart: the first gravel counts from its own place on."""
    history, _ = drive(start(), ["grass", "gravel", "gravel"], spacing_m=1.0)
    assert changes(history) == [(2.0, "gravel")]


def test_unknown_ground_between_two_terrains_is_parted_in_the_middle():
    """Grass to 1.0 m, unknown at 1.25 m, gravel from 1.5 m on."""
    history, _ = drive(start(), ["grass", "unknown", "gravel", "gravel"])
    assert changes(history) == [(1.25, "gravel")]


def test_one_label_does_not_switch():
    history, events = drive(start(), ["grass", "gravel", "grass", "gravel", "grass", "grass"])
    assert changes(history) == events == []


def test_labels_that_differ_make_no_row():
    history, events = drive(start(), ["gravel", "sand", "gravel", "sand", "gravel", "sand"])
    assert changes(history) == events == []


@pytest.mark.parametrize("needed", [1, 2, 3, 5])
def test_the_number_of_equal_labels_is_configurable(needed):
    few = ["gravel"] * (needed - 1) + ["grass"] * 3
    assert changes(drive(start(labels_in_row=needed), few)[0]) == []
    enough = ["gravel"] * needed + ["grass"] * (needed - 1)
    history, _ = drive(start(labels_in_row=needed), enough)
    assert changes(history)[0] == (max(1.0, 0.25 * (needed - 1)), "gravel")


def test_unknown_never_switches():
    history, events = drive(start(), ["unknown"] * 8)
    assert changes(history) == events == []


def test_unknown_breaks_a_row():
    history, _ = drive(start(), ["gravel", "unknown", "gravel", "unknown", "gravel", "grass"])
    assert changes(history) == []


def test_an_image_without_a_label_does_not_break_a_row():
    assert changes(drive(start(), ["gravel", "", "gravel"])[0]) == [(1.0, "gravel")]


def test_on_request_a_label_counts_when_it_is_seen():
    history, (event,) = drive(start(on_arrival=False), ["grass", "gravel", "gravel", "gravel"])
    assert changes(history) == [(0.5, "gravel")]  # the second label
    assert event.waited_m == pytest.approx(0.25)


def test_nothing_is_in_force_before_the_robot_is_there():
    switch = start().see(seen_at(0.0, "gravel")).see(seen_at(0.25, "gravel"))
    before = switch.at(1.9, np.array([0.99, 0.0, 0.0]), 0.99)
    assert before.in_force == "grass"
    assert before.ahead == "gravel"
    there = before.at(2.0, np.array([1.0, 0.0, 0.0]), 1.0)
    assert there.in_force == there.ahead == "gravel"
    assert there.at(2.1, np.array([1.05, 0.0, 0.0]), 1.05).event is None


def test_ahead_is_along_the_heading_of_the_robot():
    """The place lies at (0, 1), and the robot looks along y."""
    sight = Sight("gravel", 0.0, 0.0, np.array([0.0, 1.0]), 1.0)
    switch = start(labels_in_row=1).see(sight)
    assert switch.at(1.0, np.array([0.0, 0.9, math.pi / 2]), 0.9).in_force == "grass"
    assert switch.at(1.0, np.array([0.0, 1.0, math.pi / 2]), 1.0).in_force == "gravel"


def test_a_place_the_robot_turned_away_from_is_forgotten():
    """It saw gravel 1 m ahead, turned left on the spot and left along y."""
    switch = start().see(seen_at(0.0, "gravel")).see(seen_at(0.0, "gravel"))
    for y in np.arange(0.0, 5.0, 0.05):
        switch = switch.at(y, np.array([0.0, y, math.pi / 2]), y)
        assert switch.in_force == "grass"
    assert switch.waiting == ()
    assert switch.ahead == "grass"


def test_a_forgotten_terrain_can_be_seen_again():
    switch = start().see(seen_at(0.0, "gravel")).see(seen_at(0.0, "gravel"))
    switch = switch.at(10.0, np.array([0.0, 5.0, 0.0]), 5.0)
    assert switch.waiting == ()
    place = np.array([1.0, 5.0])
    for stamp_s in (10.0, 11.0):
        switch = switch.see(Sight("gravel", stamp_s, 5.0, place, 1.0))
    assert switch.at(12.0, np.array([1.0, 5.0, 0.0]), 6.0).in_force == "gravel"


def test_a_place_passed_far_aside_is_not_reached():
    switch = start(labels_in_row=1).see(seen_at(0.0, "gravel"))
    assert switch.at(2.0, np.array([1.1, 1.1 * REACH_M, 0.0]), 1.1).in_force == "grass"
    assert switch.at(2.0, np.array([1.1, 0.9 * REACH_M, 0.0]), 1.1).in_force == "gravel"


def test_a_strip_narrower_than_the_look_ahead():
    """Gravel of 0.5 m is seen whole, and grass beyond it, before the robot is there."""
    history, events = drive(start(), ["grass", "gravel", "gravel", "grass", "grass", "grass"])
    assert changes(history) == [(1.15, "gravel"), (1.65, "grass")]
    assert [event.terrain for event in events] == ["gravel", "grass"]


def test_three_terrains_come_into_force_in_turn():
    labels = ["gravel"] * 2 + ["sand"] * 2 + ["grass"] * 2
    assert changes(drive(start(), labels)[0]) == [(1.0, "gravel"), (1.4, "sand"), (1.9, "grass")]


def test_of_two_places_reached_at_once_the_later_label_counts():
    """Labels of nearly one place: gravel twice, then on nearer looking sand twice."""
    switch = start()
    for x, label, ahead_m in [
        (0.0, "gravel", 1.00),
        (0.1, "gravel", 0.95),
        (0.2, "sand", 0.85),
        (0.3, "sand", 0.80),
    ]:
        switch = switch.see(seen_at(x, label, ahead_m))
    switch = switch.at(2.2, np.array([1.1, 0.0, 0.0]), 1.1)
    assert switch.in_force == "sand"
    assert switch.waiting == ()


def test_a_change_that_was_taken_back_does_not_switch():
    """Gravel 1 m ahead; nearer by, the same place turns out to be grass."""
    switch = start()
    for x, label, ahead_m in [(0.0, "gravel", 1.0), (0.1, "gravel", 1.0)]:
        switch = switch.see(seen_at(x, label, ahead_m))
    for x, label, ahead_m in [(0.2, "grass", 0.8), (0.3, "grass", 0.8)]:
        switch = switch.see(seen_at(x, label, ahead_m))
    switch = switch.at(2.1, np.array([1.05, 0.0, 0.0]), 1.05)
    assert switch.in_force == "grass"
    assert switch.event is None
    assert switch.waiting == ()


def test_labels_farther_apart_than_the_look_ahead_still_switch():
    """The first place is passed before the second label confirms it: switch then, not never."""
    history, (event,) = drive(start(), ["grass", "gravel", "gravel", "gravel"], spacing_m=3.0)
    assert changes(history) == [(6.0, "gravel")]
    assert event.waited_m == pytest.approx(3.0)


def test_a_call_gives_a_new_switch_and_leaves_the_old():
    switch = start()
    before = dataclasses.replace(switch)
    switch.see(seen_at(0.0, "gravel")).see(seen_at(0.1, "gravel")).at(2.0, np.ones(3), 2.0)
    assert switch == before
    with pytest.raises(dataclasses.FrozenInstanceError):
        switch.in_force = "gravel"


def test_no_label_in_a_row_makes_no_sense():
    with pytest.raises(ConfigError, match="labels_in_row"):
        SwitchConfig(labels_in_row=0)


@settings(max_examples=60)
@given(
    strips=st.lists(st.floats(2.2, 5.0), min_size=1, max_size=4),
    share=st.floats(0.05, 0.95),
)
def test_with_true_labels_the_change_is_near_the_edge(strips, share):
    """Names alternate at the edges; a label is that of the ground 1 m ahead.

    The edge is taken half-way between the last place before it and the first beyond it, unless
    these are farther apart than the reach: then it is the latter. The second label is seen one
    spacing later: after the place is passed, if the spacing exceeds the look-ahead.
    """
    spacing_m = share * min(strips) / 2  # two labels in each strip, at least
    edges = np.cumsum(strips)

    def true_at(x):
        return ("grass", "gravel")[int(np.searchsorted(edges, x, side="right")) % 2]

    count = int(edges[-1] / spacing_m) + 3
    labels = [true_at(k * spacing_m + AHEAD_M) for k in range(count)]
    history, _ = drive(start(true_at(AHEAD_M)), labels, spacing_m, step_m=0.02)
    wanted = [edge for edge in edges if edge > AHEAD_M]
    found = changes(history)
    assert [name for _, name in found] == [true_at(edge + 1e-6) for edge in wanted]
    step_m = 0.02  # labels are seen, and changes found, at the next step
    half_m = spacing_m / 2
    most_early_m = (half_m if spacing_m <= REACH_M + step_m else 0.0) + step_m + 0.001
    most_late_m = half_m if spacing_m <= REACH_M - step_m else spacing_m
    most_late_m += max(0.0, spacing_m - AHEAD_M) + 2 * step_m + 0.01
    for edge, (x, _) in zip(wanted, found, strict=True):
        assert -most_early_m <= x - edge <= most_late_m
