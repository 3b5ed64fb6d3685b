import numpy as np
import pytest

from terrain.classification.features.copies import COLOUR_COPIES, GREY_COPIES, Copies
from terrain.classification.features.filters import Scales
from terrain.images import to_grey


def test_copies_are_those_of_the_filters_and_made_once(rng):
    image = rng.integers(0, 256, (40, 48, 3), dtype=np.uint8)
    copies = Copies(image)
    assert not copies
    scales = Scales(to_grey(image))
    for name, of in GREY_COPIES.items():
        np.testing.assert_array_equal(copies[name], of(scales))
        assert copies[name] is copies[name]
    for name, of in COLOUR_COPIES.items():
        np.testing.assert_array_equal(copies[name], of(image))
    assert list(copies) == [*GREY_COPIES, *COLOUR_COPIES]


def test_a_copy_that_does_not_exist_is_an_error(rng):
    with pytest.raises(KeyError, match="wavelets"):
        Copies(rng.integers(0, 256, (8, 8), dtype=np.uint8))["wavelets"]
