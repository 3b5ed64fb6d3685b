"""When a label becomes the terrain in force: drives worked out by hand."""

import dataclasses

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from odometry.errors import ConfigError
from terrain.switch.switch import SwitchConfig
from tests.terrain.switch.straight_drives import (
    AHEAD_M,
    BOTH_RULES,
    changes,
    drive,
    seen_at,
    start,
)


@BOTH_RULES
def test_the_change_is_half_way_between_the_last_old_and_the_first_new_label(rule):
    """Grass to the place at 1.75 m, gravel from that at 2.0 m on."""
    history, events = drive(start(**rule), ["grass"] * 4 + ["gravel"] * 6)
    ((x, name),) = changes(history)
    assert name == "gravel"
    assert 1.875 <= x <= 1.875 + 0.1  # more than half of the points, and the next step
    (event,) = events
    assert event.terrain == event.first_label.label == "gravel"
    assert event.first_label.stamp_s == pytest.approx(2.0)
    assert event.waited_s == pytest.approx(2 * (x - 1.0))
    assert event.waited_m == pytest.approx(x - 1.0)


@BOTH_RULES
def test_an_unknown_label_between_two_terrains_goes_to_one_of_them(rule):
    """Grass to 1.75 m, unknown at 2.0 m, gravel from 2.25 m on."""
    labels = ["grass"] * 4 + ["unknown"] + ["gravel"] * 6
    ((x, name),) = changes(drive(start(**rule), labels)[0])
    assert name == "gravel"
    assert 1.9 <= x <= 2.2


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


def test_the_evidence_survives_a_few_unknown_labels():
    """Every third label is unknown, which a row of equal labels would not survive."""
    labels = ["grass", "unknown", "grass"] * 2 + ["gravel", "unknown"] * 4
    ((x, name),) = changes(drive(start(), labels)[0])
    assert name == "gravel"
    assert x == pytest.approx(2.375, abs=0.15)  # half-way from the place at 2.25 m to 2.5 m
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
            switch = switch.add_label(seen_at(0.25 * k, "gravel", probabilities=given_))
        probabilities.append(
            switch.place_beliefs.probability(switch.place_beliefs.beliefs[-1], "gravel")
        )
    assert probabilities[0] > 0.9
    assert probabilities[1] < 0.5


def test_labels_of_one_place_never_make_a_change():
    """A robot that creeps sees one place in a hundred images: one look, which may be wrong."""
    switch = start()
    for _ in range(100):
        switch = switch.add_label(seen_at(0.001, "gravel"))
    assert switch.at(3.0, np.array([1.0, 0.0, 0.0]), 1.0).in_force == "grass"
    for k in range(1, 4):
        switch = switch.add_label(seen_at(0.25 * k, "gravel"))
    assert switch.at(3.0, np.array([1.0, 0.0, 0.0]), 1.0).in_force == "gravel"


def test_a_stretch_seen_again_says_no_more():
    """It goes to and fro before 0.3 m that look like gravel, and sees them ten times."""
    switch = start()
    for k in range(6):
        switch = switch.add_label(seen_at(0.15 * k, "grass"))
    stretch = [seen_at(x, "gravel") for x in (0.9, 1.05, 1.2)]
    beliefs = []
    for _ in range(10):
        for place_label in stretch:
            switch = switch.add_label(place_label)
        place_beliefs = switch.place_beliefs
        place = int(np.abs(place_beliefs.places[:, 0] - 1.9).argmin())
        beliefs.append(place_beliefs.probability(place_beliefs.beliefs[place], "gravel"))
    assert beliefs[-1] == pytest.approx(beliefs[0], abs=0.05)
    assert len(place_beliefs.places) == 36
    assert (np.diff(place_beliefs.places[:, 0]) >= 0).all()


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


@pytest.mark.parametrize("yaw", [0.0, np.pi])
def test_the_terrain_in_force_is_supported_by_the_middle_of_the_footprint(yaw):
    """Grass under the middle, and gravel under the front or under the rear."""
    switch = start()
    for k in range(12):
        switch = switch.add_label(seen_at(0.25 * k - 1.0, "grass" if k < 6 else "gravel"))
    switch = switch.at(9.0, np.array([1.3, 0.0, yaw]), 3.0)
    assert set(switch.shares) == {"grass", "gravel"}
    assert switch.supported_m == 3.0


def test_a_terrain_that_no_label_names_has_the_probability_zero():
    beliefs = start().add_label(seen_at(0.0, "gravel")).place_beliefs
    assert beliefs.probability(beliefs.beliefs[0], "gravel") > 0.4
    assert beliefs.probability(beliefs.beliefs[0], "sand") == 0.0


def test_a_terrain_that_no_label_names_has_what_is_not_reached():
    switch = dataclasses.replace(start(), before="gravel")
    switch = switch.add_label(seen_at(0.0, "gravel")).at(0.0, np.zeros(3), 0.0)
    assert switch.shares == {"grass": 1.0}


def test_terrain_with_right_labels_stays_known():
    switch = start()
    for x in 0.25 * np.arange(80):
        switch = switch.add_label(seen_at(x, "grass" if x < 9 else "gravel"))
        switch = switch.at(2 * x, np.array([x, 0.0, 0.0]), x)
        assert switch.footing.terrain != "unknown" or abs(x - 9.9) < 0.3


def test_a_call_gives_a_new_switch_and_leaves_the_old():
    switch = start()
    before = dataclasses.replace(switch)
    switch.add_label(seen_at(0.0, "gravel")).add_label(seen_at(0.1, "gravel")).at(
        2.0, np.ones(3), 2.0
    )
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
