"""Box counts against loops over boxes; dimensions of shapes that have one."""

import math

import numpy as np
import pytest
from hypothesis import given
from hypothesis.extra.numpy import array_shapes, arrays

from terrain.texture.box_counting import (
    box_counts,
    byte_histogram,
    count_bytes,
    fractal_dimension,
)

byte_images = arrays(np.uint8, array_shapes(min_dims=2, max_dims=2, max_side=19))


@given(byte_images)
def test_counts_are_those_of_boxes_looked_at_one_by_one(bits):
    counts = box_counts(bits)

    longer_side = max(bits.shape)
    sides = [2**k for k in range(math.ceil(math.log2(longer_side)) + 1)]
    assert counts.shape == (len(sides), 8)
    for row, side in enumerate(sides):
        boxes = [
            np.bitwise_or.reduce(bits[r : r + side, c : c + side], axis=None)
            for r in range(0, bits.shape[0], side)
            for c in range(0, bits.shape[1], side)
        ]
        for bit in range(8):
            assert counts[row, bit] == sum(int(box) >> bit & 1 for box in boxes)


@pytest.mark.parametrize(
    ("shape", "dimension"),
    [
        (np.ones((64, 64), np.uint8), 2.0),
        (np.eye(64, dtype=np.uint8), 1.0),
        (np.eye(1, 64, 5, dtype=np.uint8), 0.0),
        (np.zeros((64, 64), np.uint8), 0.0),
        (np.ones((1, 1), np.uint8), 0.0),
    ],
)
def test_dimension_of_plane_line_point_and_nothing(shape, dimension):
    assert fractal_dimension(box_counts(shape))[0] == pytest.approx(dimension, abs=1e-12)


def test_dimension_of_a_sierpinski_carpet_of_twos():
    """Three of four quarters, again and again: log 3 / log 2."""
    carpet = np.ones((1, 1), np.uint8)
    for _ in range(6):
        carpet = np.kron(np.array([[1, 1], [1, 0]], np.uint8), carpet)
    assert fractal_dimension(box_counts(carpet))[0] == pytest.approx(math.log2(3.0), rel=1e-12)


def test_slope_is_that_of_numpy():
    counts = np.array([[900.0], [310.0], [77.0], [25.0], [4.0], [1.0]])
    sides = 2.0 ** np.arange(6)
    slope, _ = np.polyfit(np.log(1.0 / sides), np.log(counts[:, 0]), 1)
    assert fractal_dimension(counts)[0] == pytest.approx(slope, rel=1e-12)


@given(byte_images)
def test_histogram_counts_every_value(values):
    np.testing.assert_array_equal(
        byte_histogram(values), np.bincount(values.ravel(), minlength=256)
    )


@pytest.mark.parametrize("shape", [(1, 1), (15, 17), (16, 16), (40, 23)])
def test_planes_are_counted_as_each_alone(shape, rng):
    """Few and many, small and large; all bits of all pixels set is the largest sum."""
    planes = rng.integers(0, 256, (7, *shape), dtype=np.uint8)
    planes[3] = 255
    alone = np.stack([box_counts(plane) for plane in planes])
    np.testing.assert_array_equal(box_counts(planes), alone)


def test_each_value_of_a_plane_is_counted():
    plane = np.repeat(np.arange(256, dtype=np.uint8), np.arange(256) % 3 + 1)[None]
    histograms = np.zeros((1, 256), np.float32)
    count_bytes([plane], histograms)
    assert histograms[0].tolist() == (np.arange(256) % 3 + 1).tolist()
