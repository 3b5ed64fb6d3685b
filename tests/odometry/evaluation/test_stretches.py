"""Stretches of one terrain."""

import numpy as np
from hypothesis import given
from hypothesis import strategies as st

from odometry.evaluation.stretches import Stretch, stretches, terrain_at

STAMPS_S = np.array([0.0, 1.0, 2.5, 3.0, 4.0])


def test_equal_neighbours_are_joined():
    found = stretches(STAMPS_S, ["ice", "ice", "snow", "snow", "ice"])
    assert found == (Stretch("ice", 0, 2.5), Stretch("snow", 2.5, 4), Stretch("ice", 4, 4))


def test_rows_without_a_name_go_on_as_before():
    found = stretches(STAMPS_S, ["", "ice", "", "ice", "snow"])
    assert found == (Stretch("ice", 1, 4), Stretch("snow", 4, 4))
    assert stretches(STAMPS_S, [""] * 5) == ()


@given(st.lists(st.sampled_from(["ice", "snow", "mud"]), min_size=1, max_size=12))
def test_each_row_finds_its_own_terrain_again(names):
    found = stretches(np.arange(len(names)), names)
    assert [terrain_at(found, i) for i in range(len(names))] == names
    assert terrain_at(found, -0.1) == terrain_at(found, len(names)) == ""
