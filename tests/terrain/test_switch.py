"""When a label becomes the terrain in force: drives worked out by hand."""

import dataclasses
import math
from itertools import pairwise

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from odometry.errors import ConfigError
from terrain.places import Footprint, Sight
from terrain.switch import Switch, SwitchConfig

FOOTPRINT = Footprint(0.5, 0.5)  # regions are of 0.6 m by 0.6 m
AHEAD_M = 1.0
RULES = {"evidence": {}, "rows": {"labels_in_row": 2}}
BOTH_RULES = pytest.mark.parametrize("rule", RULES.values(), ids=RULES)


def start(in_force="grass", **settings_):
    return Switch(in_force, FOOTPRINT, SwitchConfig(**settings_))


def seen_at(x, label, ahead_m=AHEAD_M, probabilities=None):
    """A label seen by a robot at (x, 0), heading along x."""
    place = np.array([x + ahead_m, 0.0])
    return Sight(label, 2 * x, x, place, ahead_m, probabilities or {})


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


@BOTH_RULES
def test_the_change_is_half_way_between_the_last_old_and_the_first_new_label(rule):
    """Grass to the place at 1.75 m, gravel from that at 2.0 m on."""
    history, events = drive(start(**rule), ["grass"] * 4 + ["gravel"] * 6)
    ((x, name),) = changes(history)
    assert name == "gravel"
    assert 1.875 <= x <= 1.875 + 0.1  # more than half of the points, and the next step
    (event,) = events
    assert event.terrain == event.sight.label == "gravel"
    assert event.sight.stamp_s == pytest.approx(2.0)
    assert event.waited_s == pytest.approx(2 * (x - 1.0))
    assert event.waited_m == pytest.approx(x - 1.0)


@BOTH_RULES
def test_unknown_ground_between_two_terrains_is_parted_in_the_middle(rule):
    """Grass to 1.75 m, unknown at 2.0 m, gravel from 2.25 m on."""
    labels = ["grass"] * 4 + ["unknown"] + ["gravel"] * 6
    ((x, name),) = changes(drive(start(**rule), labels)[0])
    assert name == "gravel"
    assert 2.0 <= x <= 2.1


@BOTH_RULES
@pytest.mark.parametrize("labels", [["unknown"] * 8, [""] * 8, ["grass"] * 8])
def test_what_names_no_other_terrain_never_switches(rule, labels):
    history, events = drive(start(**rule), labels)
    assert changes(history) == events == []


@BOTH_RULES
@pytest.mark.parametrize("where", range(1, 9))
def test_one_wrong_label_among_right_ones_does_not_switch(rule, where):
    labels = ["grass"] * 10
    labels[where] = "gravel"
    assert changes(drive(start(**rule), labels)[0]) == []


def test_unknown_takes_nothing_from_the_evidence():
    """Every other label is unknown, which a row of equal labels would not survive."""
    labels = ["grass", "unknown"] * 3 + ["gravel", "unknown"] * 6
    ((x, name),) = changes(drive(start(), labels)[0])
    assert name == "gravel"
    assert x == pytest.approx(2.25, abs=0.15)  # half-way from the place at 2.0 m to 2.5 m
    assert changes(drive(start(labels_in_row=2), labels)[0]) == []


def test_evidence_survives_what_breaks_a_row():
    """A wrong label in the middle of each terrain."""
    labels = ["grass", "grass", "sand", "grass", "grass", "grass", "grass"]
    labels += ["gravel", "gravel", "gravel", "grass", "gravel", "gravel", "gravel", "gravel"]
    ((x, name),) = changes(drive(start(), labels)[0])
    assert name == "gravel"
    assert x == pytest.approx(2.625, abs=0.15)


def test_a_label_of_low_confidence_says_less():
    sure, unsure = {"gravel": 1.0}, {"gravel": 0.4, "grass": 0.35, "sand": 0.25}
    probabilities = []
    for given_ in (sure, unsure):
        switch = start()
        for k in range(4):
            switch = switch.see(seen_at(0.25 * k, "gravel", probabilities=given_))
        probabilities.append(switch.settled.probability(switch.settled.beliefs[-1], "gravel"))
    assert probabilities[0] > 0.9
    assert probabilities[1] < 0.5


def test_labels_of_one_place_never_make_a_change():
    """A robot that creeps sees one place in a hundred images: one look, which may be wrong."""
    switch = start()
    for _ in range(100):
        switch = switch.see(seen_at(0.001, "gravel"))
    assert switch.at(3.0, np.array([1.0, 0.0, 0.0]), 1.0).in_force == "grass"
    for k in range(1, 4):
        switch = switch.see(seen_at(0.25 * k, "gravel"))
    assert switch.at(3.0, np.array([1.0, 0.0, 0.0]), 1.0).in_force == "gravel"


def test_a_stretch_seen_again_says_no_more():
    """It goes to and fro before 0.3 m that look like gravel, and sees them ten times."""
    switch = start()
    for k in range(6):
        switch = switch.see(seen_at(0.15 * k, "grass"))
    stretch = [seen_at(x, "gravel") for x in (0.9, 1.05, 1.2)]
    beliefs = []
    for _ in range(10):
        for sight in stretch:
            switch = switch.see(sight)
        settled = switch.settled
        place = int(np.abs(settled.places[:, 0] - 1.9).argmin())
        beliefs.append(settled.probability(settled.beliefs[place], "gravel"))
    assert beliefs[-1] == pytest.approx(beliefs[0], abs=0.05)
    assert len(settled.places) == 36
    assert (np.diff(settled.places[:, 0]) >= 0).all()


@pytest.mark.parametrize("needed", [1, 2, 3, 5])
def test_so_many_equal_labels_in_a_row(needed):
    few = ["gravel"] * (needed - 1) + ["grass"] * 3
    assert changes(drive(start(labels_in_row=needed), few)[0]) == []
    enough = ["grass"] + ["gravel"] * needed + ["grass"] * (needed - 1)
    ((x, name), *_) = changes(drive(start(labels_in_row=needed), enough)[0])
    assert name == "gravel"
    assert max(1.125, 0.25 * needed) <= x <= max(1.125, 0.25 * needed) + 0.1


def test_unknown_breaks_a_row_and_an_image_without_a_label_does_not():
    rows = {"labels_in_row": 2}
    unknown = ["grass", "gravel", "unknown", "gravel", "unknown", "gravel", "grass"]
    assert changes(drive(start(**rows), unknown)[0]) == []
    missing = ["grass", "gravel", "", "gravel", "gravel"]
    assert [name for _, name in changes(drive(start(**rows), missing)[0])] == ["gravel"]


def test_on_request_a_label_counts_when_it_is_seen():
    labels = ["grass", "gravel", "gravel", "gravel"]
    history, (event,) = drive(start(on_arrival=False, labels_in_row=2), labels)
    assert changes(history) == [(0.5, "gravel")]  # the second label
    assert event.waited_m == pytest.approx(0.25)


@BOTH_RULES
def test_turning_on_the_spot_before_an_edge_reaches_nothing(rule):
    """The middle stands 0.42 m before the edge, and turns once round."""
    switch = start(**rule)
    for x in np.arange(0.0, 2.01, 0.05):
        if x <= 1.9 and round(x / 0.05) % 5 == 0:
            label = "grass" if x + AHEAD_M < 2.42 else "gravel"
            switch = switch.see(seen_at(x, label))
        switch = switch.at(2 * x, np.array([x, 0.0, 0.0]), x)
    for k, yaw in enumerate(np.arange(0.0, 2 * math.pi, 0.1)):
        switch = switch.at(4.0 + 0.1 * k, np.array([2.0, 0.0, yaw]), 2.0 + 0.04 * k)
        assert switch.in_force == "grass"


@BOTH_RULES
def test_reversing_switches_where_driving_ahead_did(rule):
    """Over the edge and back: no new label, the places behind are known."""
    switch = start(**rule)
    ahead = np.arange(0.0, 4.0, 0.05)
    found = []
    for k, x in enumerate([*ahead, *ahead[::-1]]):
        if k < len(ahead) and k % 5 == 0:
            switch = switch.see(seen_at(x, "grass" if x + AHEAD_M < 2.0 else "gravel"))
        switch = switch.at(0.1 * k, np.array([x, 0.0, 0.0]), 0.05 * k)
        found += [(x, switch.event.terrain)] if switch.event else []
    (over, gravel), (back, grass) = found
    assert (gravel, grass) == ("gravel", "grass")
    assert over == pytest.approx(1.875, abs=0.1)
    assert back == pytest.approx(1.875, abs=0.1)


@BOTH_RULES
def test_labels_on_either_side_of_a_long_way_do_not_fire_before_their_place(rule):
    """One gravel label, 20 m without any, one more: it counts at its own place."""
    switch = start(**rule).see(seen_at(0.0, "gravel"))
    for k, x in enumerate(np.arange(0.0, 22.0, 0.05)):
        if k == 400:
            switch = switch.see(seen_at(x, "gravel"))
        # driven aside of the first place
        switch = switch.at(2 * x, np.array([x, 2.0 if x < 10 else 0.0, 0.0]), x)
        if 2.0 < x < 20.0 + AHEAD_M - FOOTPRINT.radius_m:
            assert switch.in_force == "grass"


@BOTH_RULES
def test_a_place_the_robot_turned_away_from_is_not_reached(rule):
    """It saw gravel 1 m ahead, turned left on the spot and left along y."""
    switch = start(**rule).see(seen_at(0.0, "gravel")).see(seen_at(0.0, "gravel"))
    for y in np.arange(0.0, 5.0, 0.05):
        switch = switch.at(y, np.array([0.0, y, math.pi / 2]), y)
        assert switch.in_force == "grass"


def test_a_strip_narrower_than_the_look_ahead():
    """Gravel of 0.75 m is seen whole, and grass beyond it, before the robot is there."""
    labels = ["grass"] * 3 + ["gravel"] * 3 + ["grass"] * 3
    found = changes(drive(start(labels_in_row=2), labels)[0])
    assert [name for _, name in found] == ["gravel", "grass"]
    assert [x for x, _ in found] == pytest.approx([1.625, 2.375], abs=0.1)


def test_a_change_that_was_taken_back_does_not_switch():
    """Gravel 1 m ahead; nearer by, the same place turns out to be grass."""
    switch = start(labels_in_row=2)
    for x, label, ahead_m in [(0.0, "gravel", 1.0), (0.1, "gravel", 1.0)]:
        switch = switch.see(seen_at(x, label, ahead_m))
    for x, label, ahead_m in [(0.2, "grass", 0.8), (0.3, "grass", 0.8)]:
        switch = switch.see(seen_at(x, label, ahead_m))
    switch = switch.at(2.1, np.array([0.95, 0.0, 0.0]), 0.95)
    assert switch.in_force == "grass"
    assert switch.event is None


def test_a_robot_astride_an_edge_has_shares_of_both_terrains():
    """Edge at 1.875 m; the footprint is 0.5 m long."""
    switch = start()
    for k in range(12):
        switch = switch.see(seen_at(0.25 * k, "grass" if k < 4 else "gravel"))
    for x in np.arange(1.4, 2.4, 0.05):
        switch = switch.at(2 * x, np.array([x, 0.0, 0.0]), 2.75)
        over = np.clip((x + 0.25 - 1.875) / 0.5, 0.0, 1.0)
        assert switch.footing.shares.get("gravel", 0.0) == pytest.approx(over, abs=0.08)
        assert sum(switch.footing.shares.values()) == pytest.approx(1.0)


def test_on_request_the_terrain_changes_in_one_step():
    switch = start(by_shares=False)
    for k in range(12):
        switch = switch.see(seen_at(0.25 * k, "grass" if k < 4 else "gravel"))
    footings = [switch.at(2 * x, np.array([x, 0.0, 0.0]), 2.75).footing for x in (1.8, 1.95)]
    assert [footing.shares for footing in footings] == [{"grass": 1.0}, {"gravel": 1.0}]


def test_ground_without_a_label_for_long_is_no_longer_known():
    switch = start()
    for x in np.arange(0.0, 40.0, 0.25):
        switch = switch.see(seen_at(x, "grass" if x < 5 else "unknown"))
        switch = switch.at(2 * x, np.array([x, 0.0, 0.0]), x)
        if x < 6.0:
            assert switch.footing.terrain == "grass"
    assert switch.in_force == "grass"
    assert switch.footing.terrain == "unknown"


def test_ground_that_labels_contradict_is_no_longer_known():
    switch = start()
    labels = np.random.default_rng(1).choice(["grass", "gravel", "sand"], 80)
    known = []
    for x, label in zip(0.25 * np.arange(80), labels, strict=True):
        switch = switch.see(seen_at(x, str(label)))
        switch = switch.at(2 * x, np.array([x, 0.0, 0.0]), x)
        known.append(switch.footing.terrain != "unknown")
    assert np.mean(known) < 0.9


def test_ground_with_right_labels_stays_known():
    switch = start()
    for x in 0.25 * np.arange(80):
        switch = switch.see(seen_at(x, "grass" if x < 9 else "gravel"))
        switch = switch.at(2 * x, np.array([x, 0.0, 0.0]), x)
        assert switch.footing.terrain != "unknown" or abs(x - 9.9) < 0.3


@BOTH_RULES
def test_what_lies_behind_is_forgotten_and_changes_nothing(rule):
    """300 m of grass and gravel by turns: as many places are kept as the odometer can tell."""
    switch = start(**rule)
    for x in 0.25 * np.arange(400):
        switch = switch.see(seen_at(x, ("grass", "gravel")[int(x // 30) % 2]))
        switch = switch.at(2 * x, np.array([x, 0.0, 0.0]), x)
        if x > 1.5 and abs(x - 1 - 30 * round((x - 1) / 30)) > 0.4:
            assert switch.in_force == ("grass", "gravel")[int((x - 1) // 30) % 2]
    assert len(switch.sights) < 80


@BOTH_RULES
def test_a_robot_that_went_astray_knows_no_place(rule):
    switch = start(**rule)
    for k in range(6):
        switch = switch.see(seen_at(0.25 * k, "gravel"))
    assert switch.at(2.0, np.array([1.3, 0.0, 0.0]), 1.3).in_force == "gravel"
    astray = switch.astray().at(2.0, np.array([1.3, 0.0, 0.0]), 1.3)
    assert (astray.in_force, astray.sights) == ("grass", ())
    for k in range(6):
        astray = astray.see(seen_at(2.0 + 0.25 * k, "gravel"))
    assert astray.at(6.0, np.array([3.1, 0.0, 0.0]), 3.1).in_force == "gravel"


def test_a_call_gives_a_new_switch_and_leaves_the_old():
    switch = start()
    before = dataclasses.replace(switch)
    switch.see(seen_at(0.0, "gravel")).see(seen_at(0.1, "gravel")).at(2.0, np.ones(3), 2.0)
    assert switch == before
    with pytest.raises(dataclasses.FrozenInstanceError):
        switch.in_force = "gravel"


@pytest.mark.parametrize(
    ("key", "value"),
    [
        ("labels_in_row", -1),
        ("label_accuracy", 1.0),
        ("label_accuracy", 0.0),
        ("change_m", 0.0),
        ("alike_m", 0.0),
    ],
)
def test_a_setting_without_sense_is_refused(key, value):
    with pytest.raises(ConfigError, match=key):
        SwitchConfig(**{key: value})


@BOTH_RULES
@settings(max_examples=15, deadline=None)
@given(
    strips=st.lists(st.floats(2.2, 5.0), min_size=1, max_size=2),
    spacing_m=st.floats(0.1, 0.4),
)
def test_with_true_labels_the_change_is_near_the_edge(rule, strips, spacing_m):
    """Names alternate at the edges; a label is that of the ground 1 m ahead."""
    edges = np.cumsum(strips)

    def true_at(x):
        return ("grass", "gravel")[int(np.searchsorted(edges, x, side="right")) % 2]

    count = int(edges[-1] / spacing_m) + 3
    labels = [true_at(k * spacing_m + AHEAD_M) for k in range(count)]
    history, _ = drive(start("grass", **rule), labels, spacing_m)
    found = changes(history)
    assert [name for _, name in found] == [true_at(edge + 1e-6) for edge in edges]
    for edge, (x, _) in zip(edges, found, strict=True):
        assert abs(x - edge) <= spacing_m / 2 + 0.5 / 15 + 0.051
