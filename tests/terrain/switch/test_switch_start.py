"""The terrain of the start: named and not supported, or not known."""

import numpy as np
import pytest

from terrain.switch.switch import SwitchConfig
from tests.terrain.switch.straight_drives import (
    AHEAD_M,
    BOTH_RULES,
    FOOTPRINT,
    changes,
    drive,
    seen_at,
    start,
)


@pytest.mark.parametrize("labels_from_m", [0.0, 5.0, np.inf])
def test_a_start_that_no_label_supports_is_no_longer_known(labels_from_m):
    """Whether no image shows a region, or all of them are unknown."""
    switch = start()
    for x in np.arange(0.0, 12.0, 0.25):
        if x >= labels_from_m:
            switch = switch.add_label(seen_at(x, "unknown"))
        switch = switch.at(2 * x, np.array([x, 0.0, 0.0]), x)
        if labels_from_m > 0 or not AHEAD_M - FOOTPRINT.radius_m < x <= SwitchConfig().unknown_m:
            is_known = x <= SwitchConfig().unknown_m
            assert switch.footing.terrain == ("grass" if is_known else "unknown")
    assert switch.in_force == "grass"


@BOTH_RULES
def test_a_start_of_which_nothing_is_known_ends_with_the_first_place(rule):
    for name in ("grass", "gravel"):
        history, (event,) = drive(start("unknown", **rule), [name] * 4)
        ((x, terrain),) = changes(history)
        assert (history[0][1], terrain, event.terrain) == ("unknown", name, name)
        assert AHEAD_M - FOOTPRINT.radius_m <= x <= AHEAD_M


def test_a_start_of_which_nothing_is_known_favours_no_terrain():
    switch = start("unknown").add_label(seen_at(0.0, "a", probabilities={"a": 0.5, "b": 0.5}))
    a, b = (switch.place_beliefs.probability(switch.place_beliefs.beliefs[0], n) for n in "ab")
    assert a == pytest.approx(b, abs=1e-12)
    assert a + b > 0.9
