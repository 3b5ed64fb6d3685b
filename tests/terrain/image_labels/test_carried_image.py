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
    moved, in_block, known = carried_back(down(60), after, STEP, 16)
    assert 0.3 < known.sum() / in_block.size < 1.0
    there = tiles(moved, 16)[known]
    earlier, later = (tiles(image, 16)[in_block][known] for image in (before, after))
    assert np.corrcoef(there.ravel(), earlier.ravel())[0, 1] > 0.98
    assert np.corrcoef(later.ravel(), earlier.ravel())[0, 1] < 0.5


def test_terrain_that_left_the_image_is_in_no_square(terrain):
    ahead, away = (np.array([x, 0.0, 0.0]) for x in (0.3, 9.0))
    image = seen(terrain, down(60), ahead)
    moved, in_block, known = carried_back(down(60), image, ahead, 32)
    here = middles(image.shape, 32)
    there = pixels_after(down(60), SIZE[0], ahead, places_at(down(60), SIZE[0], here))
    inside = ((there > 16) & (there < np.array(SIZE) - 17)).all(axis=1)
    assert moved.shape < image.shape
    assert np.all(known[inside[in_block]])
    assert not inside[~in_block].any()
    assert not known[(there[in_block] < 0).any(axis=1)].any()
    assert not carried_back(down(60), image, away, 32)[2].any()


def test_nothing_black_is_carried_from_beyond_the_image():
    image = np.full(SIZE[::-1], 120, np.uint8)
    for step in (np.zeros(3), STEP, -2 * STEP):
        moved, _, known = carried_back(down(60), image, step, 32)
        assert np.all(tiles(moved, 32)[known] == 120)


def test_squares_at_the_horizon_are_not_known(terrain):
    camera, step = down(10), np.array([0.1, 0.0, 0.0])
    _, in_block, known = carried_back(camera, seen(terrain, camera), step, 16)
    places = places_at(camera, SIZE[0], middles(SIZE[::-1], 16) - [0, 16])  # of the square above
    assert np.isnan(places).any()
    assert not known[np.isnan(places).any(axis=1)[in_block]].any()


@pytest.mark.parametrize("size_px", [16, 32])
def test_tiles_and_middles_are_of_the_same_squares(size_px):
    u, v = np.meshgrid(*map(np.arange, SIZE))
    for image, place in ((u, 0), (v, 1)):
        means = tiles(image, size_px).mean(axis=1)
        np.testing.assert_allclose(means, middles(image.shape, size_px)[:, place])
