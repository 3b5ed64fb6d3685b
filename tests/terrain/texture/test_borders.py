"""Borders against the definition, pixel by pixel."""

import numpy as np
from hypothesis import given
from hypothesis import strategies as st
from hypothesis.extra.numpy import array_shapes, arrays

from terrain.texture.borders import region_borders

byte_images = arrays(np.uint8, array_shapes(min_dims=2, max_dims=2, max_side=7))


def border_by_definition(binary):
    """Eq. 21: a one with a zero among those of its eight neighbours that exist."""
    rows, columns = binary.shape
    border = np.zeros_like(binary)
    for r in range(rows):
        for c in range(columns):
            around = binary[max(r - 1, 0) : r + 2, max(c - 1, 0) : c + 2]
            border[r, c] = binary[r, c] and not around.all()
    return border


@given(byte_images)
def test_each_bit_is_the_border_of_its_image(bits):
    borders = region_borders(bits)
    for bit in range(8):
        np.testing.assert_array_equal(
            borders >> bit & 1, border_by_definition(bits >> bit & 1), strict=True
        )


@given(st.integers(1, 9), st.integers(1, 9))
def test_the_edge_of_the_image_is_no_border(rows, columns):
    assert not region_borders(np.full((rows, columns), 255, np.uint8)).any()


def test_the_input_is_left_alone():
    bits = np.full((3, 3), 7, np.uint8)
    region_borders(bits)
    np.testing.assert_array_equal(bits, 7)
