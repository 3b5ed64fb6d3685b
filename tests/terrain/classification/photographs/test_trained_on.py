"""What a classifier needs to be trained on, and what it remembers of it."""

import numpy as np
import pytest

from terrain.classification.photographs.trained_on import (
    TrainedOn,
    has_colour,
    holds_images,
    labels_and_groups,
)
from terrain.errors import PatchError


def test_both_hold_what_either_was_trained_on():
    one = TrainedOn(frozenset("a"), frozenset("b"), frozenset("c"))
    other = TrainedOn(frozenset("d"), frozenset("e"), frozenset("f"))
    assert one | other == TrainedOn(frozenset("ad"), frozenset("be"), frozenset("cf"))


@pytest.mark.parametrize("count", [0, 1, 2])
def test_a_list_of_any_length_may_be_images(count):
    assert holds_images([np.zeros((4, 4), np.uint8)] * count)
    assert not holds_images([[1.0, 2.0]])


@pytest.mark.parametrize(
    ("photographs", "remedy"),
    [
        ({"mud": 2, "snow": 1}, ". Add photographs of snow"),
        ({"mud": 2, "sand": 2, "snow": 1}, ". Add photographs of snow, or leave that out"),
        ({"mud": 3}, "photographs found: mud 3"),
    ],
)
def test_a_class_of_one_photograph_is_left_out_where_two_classes_stay(photographs, remedy):
    labels = [name for name, count in photographs.items() for _ in range(count)]
    with pytest.raises(PatchError) as refused:
        labels_and_groups(len(labels), labels, None)
    assert str(refused.value).endswith(remedy)


@pytest.mark.parametrize(("coloured", "has"), [(2, False), (3, True)])
def test_most_photographs_of_each_class_must_have_colour(coloured, has):
    """Of five each: mud has colour in all of them."""
    red, grey = np.multiply(np.ones((4, 4, 3)), [9, 0, 0]), np.full((4, 4, 3), 9)
    images = [red] * 5 + [red] * coloured + [grey] * (5 - coloured)
    assert has_colour(images, np.repeat(["mud", "snow"], 5)) is has
