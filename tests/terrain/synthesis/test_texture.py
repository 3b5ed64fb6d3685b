"""A photograph on the ground: where it lies, how it repeats, and what is lost at a distance."""

import numpy as np

from terrain.synthesis.texture import Texture


def photo(shape=(40, 60), seed=0):
    return np.random.default_rng(seed).integers(0, 256, shape, dtype=np.uint8)


def look_up(texture, points, detail_m=1e-3):
    points = np.asarray(points, dtype=np.float64)
    return texture.look_up(points, np.full(points.shape[:2], detail_m))


def test_photograph_lies_where_it_is_laid():
    """Columns lead along +y and rows to the right of that, +x; pixel (7, 11) is found again."""
    image = photo()
    texture = Texture.laid(
        image, 0.01, angle_rad=np.pi / 2, photo_point_px=(0.0, 0.0), world_point=(1.0, 2.0)
    )
    row, column = 7, 11
    point = [1.0 + 0.01 * (row + 0.5), 2.0 + 0.01 * (column + 0.5)]
    np.testing.assert_allclose(look_up(texture, [[point]]), image[row, column], atol=1e-2)


def test_inner_point_lies_where_it_is_laid():
    image = photo()
    texture = Texture.laid(
        image, 0.01, angle_rad=0.7, photo_point_px=(20.5, 30.5), world_point=(-3.0, 4.0)
    )
    np.testing.assert_allclose(look_up(texture, [[[-3.0, 4.0]]]), image[30, 20], atol=1e-2)


def test_tiles_mirror_at_the_borders_of_the_photograph():
    texture = Texture.laid(
        photo((40, 60, 3)), 0.01, angle_rad=0.0, photo_point_px=(0, 0), world_point=(0, 0)
    )
    x, y = np.meshgrid(np.linspace(0.01, 1.7, 30), np.linspace(-1.3, -0.01, 30))
    here = look_up(texture, np.stack([x, y], axis=-1))
    assert here.shape == (30, 30, 3)
    for mirrored in ((-x, y), (x, -y), (1.2 - x, y), (x, -0.8 - y), (x + 1.2, y), (x, y - 0.8)):
        np.testing.assert_allclose(look_up(texture, np.stack(mirrored, axis=-1)), here, atol=0.5)


def test_distant_ground_is_averaged_without_shifting():
    """Noise averages out with the size of the detail; a ramp keeps its place at every size."""
    noise = Texture.laid(
        photo((256, 256)), 0.01, angle_rad=0.3, photo_point_px=(0, 0), world_point=(0, 0)
    )
    x, y = np.meshgrid(np.linspace(0, 2, 80), np.linspace(0, 2, 80))
    points = np.stack([x, y], axis=-1)
    spreads = [look_up(noise, points, detail).std() for detail in (0.01, 0.02, 0.04, 0.08)]
    assert (np.diff(spreads) < 0).all()
    assert spreads[-1] < spreads[0] / 5

    ramp = np.tile(np.arange(0, 201, 3, dtype=np.uint8), (67, 1))  # sizes that halve unevenly
    texture = Texture.laid(ramp, 0.01, angle_rad=0.0, photo_point_px=(0, 0), world_point=(0, 0))
    x = np.linspace(0.2, 0.45, 20)[None]
    points = np.stack([x, np.full_like(x, -0.3)], axis=-1)
    for detail in (0.01, 0.02, 0.03, 0.04):
        np.testing.assert_allclose(look_up(texture, points, detail), 300 * x - 1.5, atol=0.5)
