import numpy as np

from odometry.evaluation.stretches import Stretch, stretches, terrain_at

STAMPS_S = np.array([0.0, 1.0, 2.5, 3.0, 7.0])


def test_equal_neighbours_are_joined():
    found = stretches(STAMPS_S, ["a", "a", "b", "b", "a"])
    assert found == (Stretch("a", 0, 2.5), Stretch("b", 2.5, 7), Stretch("a", 7, 7))


def test_rows_without_a_name_carry_on():
    assert stretches(STAMPS_S, ["", "a", "", "a", "b"]) == (Stretch("a", 1, 7), Stretch("b", 7, 7))


def test_no_name_at_all():
    assert stretches(STAMPS_S, [""] * 5) == ()
    assert stretches(np.empty(0), []) == ()


def test_the_terrain_at_a_moment():
    found = stretches(STAMPS_S, ["", "a", "b", "b", "b"])
    assert [terrain_at(found, t) for t in (0.5, 1, 2.4, 2.5, 7, 7.1)] == [
        "",
        "a",
        "a",
        "b",
        "b",
        "",
    ]
