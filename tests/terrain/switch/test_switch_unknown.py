"""Terrain that has no name: by images that resemble none, and by names that contradict."""

import dataclasses

import numpy as np
import pytest

from tests.terrain.switch.straight_drives import seen_at, start


@pytest.mark.parametrize("is_evidence", [True, False])
def test_terrain_without_a_name_is_unknown_from_its_edge_on(is_evidence):
    """Images that resemble no terrain from 6 m on; where they say nothing, after `unknown_m`."""
    switch, known_to_m = start(), 0.0
    for x in np.arange(0.0, 40.0, 0.25):
        of = seen_at(x, "grass" if x < 5 else "unknown")
        switch = switch.add_label(dataclasses.replace(of, is_evidence=x < 5 or is_evidence))
        switch = switch.at(2 * x, np.array([x, 0.0, 0.0]), x)
        known_to_m = x if switch.footing.terrain == "grass" else known_to_m
        assert switch.footing.terrain == ("grass" if x == known_to_m else "unknown")
    assert switch.in_force == "grass"
    assert 6.0 <= known_to_m < 8.0 if is_evidence else 8.0 <= known_to_m <= 10.0
    after = switch.add_label(seen_at(40.0, "gravel")).at(80.0, np.array([40.0, 0.0, 0.0]), 40.0)
    assert after.footing.terrain == "unknown"  # one label of something else is no support


def test_a_terrain_with_a_name_is_known_again_after_one_without():
    switch = start()
    for x in np.arange(0.0, 16.0, 0.25):
        of = {} if 4 <= x < 10 else {"grass": 0.9, "mud": 0.05, "snow": 0.05}
        switch = switch.add_label(seen_at(x, "grass" if of else "unknown", probabilities=of))
        switch = switch.at(2 * x, np.array([x, 0.0, 0.0]), x)
        if not 4.5 < x < 8.0 and not 10.5 < x < 12.5:
            assert switch.footing.terrain == ("unknown" if 5 < x < 11 else "grass")


def test_names_among_many_unknown_labels_are_not_in_force():
    """A quarter of the images has a name, half of them of another terrain."""
    switch, rng, known = start(), np.random.default_rng(5), []
    for x in 0.25 * np.arange(120):
        name = str(rng.choice(["unknown", "grass", "gravel"], p=[0.75, 0.13, 0.12]))
        switch = switch.add_label(seen_at(x, name)).at(2 * x, np.array([x, 0.0, 0.0]), x)
        known.append(switch.footing.terrain != "unknown")
    assert np.mean(known[12:]) < 0.1


def test_terrain_that_labels_contradict_is_no_longer_known():
    switch = start()
    labels = np.random.default_rng(1).choice(["grass", "gravel", "sand"], 80)
    known = []
    for x, label in zip(0.25 * np.arange(80), labels, strict=True):
        switch = switch.add_label(seen_at(x, str(label)))
        switch = switch.at(2 * x, np.array([x, 0.0, 0.0]), x)
        known.append(switch.footing.terrain != "unknown")
    assert np.mean(known) < 0.3


def test_the_place_under_the_middle_decides_whether_a_label_supports_the_terrain():
    """One image at 4 m has no name: the robot is without support on the places nearest to it."""
    switch = start()
    for x in np.arange(0.0, 6.0, 0.25):
        switch = switch.add_label(seen_at(x, "unknown" if x == 3.0 else "grass"))
    without = []
    for x in np.arange(1.02, 6.0, 0.05):
        switch = switch.at(2 * x, np.array([x, 0.0, 0.0]), x)
        if switch.unsupported_m > 0:
            without.append(x)
    assert (min(without), max(without)) == pytest.approx((4.0, 4.0), abs=0.15)
    assert len(without) == 5
