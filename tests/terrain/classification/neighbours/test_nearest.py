"""The nearest points against sorting all distances, and against scikit-learn."""

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from hypothesis.extra.numpy import arrays
from sklearn.neighbors import NearestNeighbors

from terrain.classification.neighbours.nearest import nearest


@pytest.mark.parametrize("k", [1, 5, 39, 40])
@pytest.mark.parametrize("dimensions", [1, 2, 24])
def test_the_nearest_are_those_of_scikit_learn(k, dimensions, rng):
    points, asked = rng.normal(size=(40, dimensions)), rng.normal(size=(7, dimensions))
    their_distances, their_rows = (
        NearestNeighbors(algorithm="brute").fit(points).kneighbors(asked, k)
    )
    distances, rows = nearest(points, asked, k)
    np.testing.assert_array_equal(rows, their_rows)
    np.testing.assert_allclose(distances, their_distances, atol=1e-7)  # they lose digits


@given(arrays(np.int8, (12, 2), elements=st.integers(-2, 2)), st.integers(1, 12))
def test_distances_are_the_smallest_even_where_points_repeat(places, k):
    points = places.astype(float) + 1e4  # far from the origin, where squares lose digits
    distances, rows = nearest(points, points[:3], k)
    all_of = np.linalg.norm(points[:3, None] - points, axis=2)
    np.testing.assert_array_equal(distances, np.sort(all_of, axis=1)[:, :k])
    np.testing.assert_array_equal(distances, np.take_along_axis(all_of, rows, axis=1))
    assert all(len(set(row)) == k for row in rows.tolist())
