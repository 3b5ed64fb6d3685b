"""Terrain that is carried from one image into another."""

import numpy as np
import pytest

from odometry.geometry import se2
from terrain.image_labels.carried_image import (
    carried_back,
    middles,
    pixels_after,
    places_at,
    places_of_squares,
    tiles,
)
from tests.terrain.image_labels.test_still_image import SIZE, STEP, down, seen, terrain

__all__ = ["terrain"]


def test_there_and_back_is_the_same_place():
    here = middles((120, 160), 16)
    there = pixels_after(down(40), 160, STEP, places_of_squares(down(40), (120, 160), 16))
    back = pixels_after(down(40), 160, se2.inverse(STEP), places_at(down(40), 160, there))
    on_terrain = np.isfinite(back).all(axis=1)
    assert on_terrain.any()
    np.testing.assert_allclose(back[on_terrain], here[on_terrain], atol=1e-6)
    assert np.linalg.norm((there - here)[on_terrain], axis=1).min() > 1.0


def test_an_image_carried_back_is_the_one_before(terrain):
    before, after = (seen(terrain, down(60), pose) for pose in ((0, 0, 0), STEP))
    moved, known = carried_back(down(60), after, STEP)
    assert 0.3 < known.mean() < 1.0
    assert np.corrcoef(moved[known], before[known])[0, 1] > 0.98
    assert np.corrcoef(after[known], before[known])[0, 1] < 0.5


@pytest.mark.parametrize("size_px", [16, 32])
def test_tiles_and_middles_are_of_the_same_squares(size_px):
    u, v = np.meshgrid(*map(np.arange, SIZE))
    for image, place in ((u, 0), (v, 1)):
        means = tiles(image, size_px).mean(axis=1)
        np.testing.assert_allclose(means, middles(image.shape, size_px)[:, place])
