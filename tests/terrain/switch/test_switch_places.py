"""A terrain comes into force where the footprint passes over its place, and nowhere else."""

import math

import numpy as np
import pytest

from terrain.switch.place_labels import DRIFT, Footprint
from tests.terrain.switch.straight_drives import (
    AHEAD_M,
    BOTH_RULES,
    FOOTPRINT,
    changes,
    drive,
    seen_at,
    start,
)


@BOTH_RULES
def test_turning_on_the_spot_before_an_edge_reaches_nothing(rule):
    """The middle stands 0.42 m before the edge, and turns once round."""
    switch = start(**rule)
    for x in np.arange(0.0, 2.01, 0.05):
        if x <= 1.9 and round(x / 0.05) % 5 == 0:
            label = "grass" if x + AHEAD_M < 2.42 else "gravel"
            switch = switch.add_label(seen_at(x, label))
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
            switch = switch.add_label(seen_at(x, "grass" if x + AHEAD_M < 2.0 else "gravel"))
        switch = switch.at(0.1 * k, np.array([x, 0.0, 0.0]), 0.05 * k)
        found += [(x, switch.event.terrain)] if switch.event else []
    (over, gravel), (back, grass) = found
    assert (gravel, grass) == ("gravel", "grass")
    assert over == pytest.approx(1.875, abs=0.1)
    assert back == pytest.approx(1.875, abs=0.1)


@BOTH_RULES
def test_labels_on_either_side_of_a_long_way_do_not_fire_before_their_place(rule):
    """One gravel label, 20 m without any, one more: it counts at its own place."""
    switch = start(**rule).add_label(seen_at(0.0, "gravel"))
    for k, x in enumerate(np.arange(0.0, 22.0, 0.05)):
        if k == 400:
            switch = switch.add_label(seen_at(x, "gravel"))
        # driven aside of the first place
        switch = switch.at(2 * x, np.array([x, 2.0 if x < 10 else 0.0, 0.0]), x)
        if 2.0 < x < 20.0 + AHEAD_M - FOOTPRINT.radius_m:
            assert switch.in_force == "grass"


@BOTH_RULES
def test_a_place_the_robot_turned_away_from_is_not_reached(rule):
    """It saw gravel 1 m ahead, turned left on the spot and left along y."""
    switch = start(**rule).add_label(seen_at(0.0, "gravel")).add_label(seen_at(0.0, "gravel"))
    for y in np.arange(0.0, 5.0, 0.05):
        switch = switch.at(y, np.array([0.0, y, math.pi / 2]), y)
        assert switch.in_force == "grass"


def test_a_strip_narrower_than_the_look_ahead():
    """Gravel of 0.75 m is labelled whole, and grass beyond it, before the robot is there."""
    labels = ["grass"] * 3 + ["gravel"] * 3 + ["grass"] * 3
    found = changes(drive(start(labels_in_row=2), labels)[0])
    assert [name for _, name in found] == ["gravel", "grass"]
    assert [x for x, _ in found] == pytest.approx([1.625, 2.375], abs=0.1)


def test_a_change_that_was_taken_back_does_not_switch():
    """Gravel 1 m ahead; nearer by, the same place turns out to be grass."""
    switch = start(labels_in_row=2)
    for x, label, ahead_m in [(0.0, "gravel", 1.0), (0.1, "gravel", 1.0)]:
        switch = switch.add_label(seen_at(x, label, ahead_m))
    for x, label, ahead_m in [(0.2, "grass", 0.8), (0.3, "grass", 0.8)]:
        switch = switch.add_label(seen_at(x, label, ahead_m))
    switch = switch.at(2.1, np.array([0.95, 0.0, 0.0]), 0.95)
    assert switch.in_force == "grass"
    assert switch.event is None


def test_a_robot_astride_an_edge_has_shares_of_both_terrains():
    """Edge at 1.875 m; the footprint is 0.5 m long."""
    switch = start()
    for k in range(12):
        switch = switch.add_label(seen_at(0.25 * k, "grass" if k < 4 else "gravel"))
    for x in np.arange(1.4, 2.4, 0.05):
        switch = switch.at(2 * x, np.array([x, 0.0, 0.0]), 2.75)
        over = np.clip((x + 0.25 - 1.875) / 0.5, 0.0, 1.0)
        assert switch.footing.shares.get("gravel", 0.0) == pytest.approx(over, abs=0.08)
        assert sum(switch.footing.shares.values()) == pytest.approx(1.0)


def test_on_request_the_terrain_changes_in_one_step():
    switch = start(by_shares=False)
    for k in range(12):
        switch = switch.add_label(seen_at(0.25 * k, "grass" if k < 4 else "gravel"))
    footings = [switch.at(2 * x, np.array([x, 0.0, 0.0]), 2.75).footing for x in (1.8, 1.95)]
    assert [footing.shares for footing in footings] == [{"grass": 1.0}, {"gravel": 1.0}]


@BOTH_RULES
def test_what_lies_behind_is_forgotten_and_changes_nothing(rule):
    """300 m of grass and gravel by turns: as many places are kept as the odometer resolves."""
    switch = start(**rule)
    for x in 0.25 * np.arange(400):
        switch = switch.add_label(seen_at(x, ("grass", "gravel")[int(x // 30) % 2]))
        switch = switch.at(2 * x, np.array([x, 0.0, 0.0]), x)
        if x > 1.5 and abs(x - 1 - 30 * round((x - 1) / 30)) > 0.4:
            assert switch.in_force == ("grass", "gravel")[int((x - 1) // 30) % 2]
    assert len(switch.place_labels) < 80


@BOTH_RULES
def test_a_robot_that_went_astray_knows_no_place(rule):
    switch = start(**rule)
    for k in range(6):
        switch = switch.add_label(seen_at(0.25 * k, "gravel"))
    assert switch.at(2.0, np.array([1.3, 0.0, 0.0]), 1.3).in_force == "gravel"
    without_labels = switch.without_labels().at(2.0, np.array([1.3, 0.0, 0.0]), 1.3)
    assert (without_labels.in_force, without_labels.place_labels) == ("grass", ())
    for k in range(6):
        without_labels = without_labels.add_label(seen_at(2.0 + 0.25 * k, "gravel"))
    assert without_labels.at(6.0, np.array([3.1, 0.0, 0.0]), 3.1).in_force == "gravel"


def test_after_unknown_motion_the_terrain_of_before_is_no_evidence():
    label = seen_at(0.0, "gravel", probabilities={"grass": 0.5, "gravel": 0.5})
    beliefs = start("grass").without_labels().add_label(label).place_beliefs
    grass, gravel = (beliefs.probability(beliefs.beliefs[0], n) for n in ("grass", "gravel"))
    assert grass == pytest.approx(gravel, abs=1e-12)


def test_of_places_that_are_forgotten_together_the_last_one_counts():
    """Grass, then gravel, and no label until both are too far behind."""
    switch = start("sand")
    for x, label in enumerate(["grass"] * 5 + ["gravel"] * 5):
        switch = switch.add_label(seen_at(float(x), label))
    far_m = 9.0 + 2 * FOOTPRINT.radius_m / DRIFT
    assert switch.add_label(seen_at(far_m, "unknown")).before == "gravel"


def test_points_of_a_footprint_are_even_over_all_of_it():
    points = Footprint(0.9, 0.5).points
    assert points.shape == (75, 2)
    along, across = (np.unique(column.round(9)) for column in points.T)
    for places, length_m in ((along, 0.9), (across, 0.5)):
        steps = np.diff(places)
        np.testing.assert_allclose(steps, length_m / len(places))
        np.testing.assert_allclose(
            [places[0], places[-1]], np.array([-1, 1]) * (length_m - steps[0]) / 2
        )
