"""Which ground an image shows finely enough, and the largest rectangle of it."""

from types import SimpleNamespace

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from hypothesis.extra.numpy import arrays

from terrain.camera.camera import Camera
from terrain.region.footprint_parts import CELLS, Rectangle, is_visible, largest_visible

MATRIX = [[300.0, 0.0, 320.0], [0.0, 300.0, 240.0], [0.0, 0.0, 1.0]]
AHEAD = Camera.from_mount((640, 480), MATRIX, [-0.1, 0.02, 0, 0], [0.3, 0.0, 0.9, 0.0, 0.8, 0.0])
UNIT = Rectangle(0.0, 1.0, 0.0, 1.0)


def showing(vertices):
    """A stand-in for a camera that shows the given vertices (CELLS + 1, CELLS + 1) of UNIT."""

    def shows_terrain(points):
        row, column = np.moveaxis(np.rint(points * CELLS).astype(int), -1, 0)
        return vertices[row, column]

    return SimpleNamespace(ground_to_pixels=np.asarray, shows_terrain=shows_terrain)


def cells_of(rectangle):
    """Rows and columns of cells of UNIT that a rectangle covers."""
    bounds = np.array([rectangle.x_min, rectangle.x_max, rectangle.y_min, rectangle.y_max])
    return np.rint(bounds * CELLS).astype(int)


def largest_by_trying_all(vertices):
    """Number of cells of the largest block whose vertices are all shown."""
    ends = [(a, b) for a in range(CELLS + 1) for b in range(a + 1, CELLS + 1)]
    columns_shown = {(c, d): vertices[:, c : d + 1].all(axis=1) for c, d in ends}
    sizes = [
        (b - a) * (d - c)
        for (c, d), rows in columns_shown.items()
        for a, b in ends
        if rows[a : b + 1].all()
    ]
    return max(sizes, default=0)


@given(
    holes=arrays(bool, (4, 4)), shift=st.integers(0, 3), border=st.tuples(*[st.integers(0, 6)] * 4)
)
def test_no_other_block_of_shown_cells_is_larger(holes, shift, border):
    vertices = np.ones((CELLS + 1, CELLS + 1), dtype=bool)
    vertices[shift::4, shift::4][:4, :4] &= ~holes
    top, bottom, left, right = border
    vertices[:top] = vertices[CELLS + 1 - bottom :] = False
    vertices[:, :left] = vertices[:, CELLS + 1 - right :] = False
    a, b, c, d = cells_of(largest_visible(showing(vertices), UNIT))
    assert (b - a) * (d - c) == largest_by_trying_all(vertices)
    assert vertices[a : b + 1, c : d + 1].all() or (a, c) == (b, d)


def test_all_of_a_rectangle_is_that_rectangle():
    whole = Rectangle(0.9, 1.4, -0.2, 0.3)
    assert largest_visible(AHEAD, whole) == whole


def test_where_nothing_is_shown_the_rectangle_has_no_size():
    behind = largest_visible(AHEAD, Rectangle(-2.0, -1.0, -0.2, 0.3))
    assert (behind.x_max - behind.x_min) * (behind.y_max - behind.y_min) == 0.0


def test_from_straight_above_the_image_border_cuts_the_rectangle():
    """3 m above with 300 px focal length: 0.01 m a pixel, so that the image ends at x = 2.4."""
    camera = Camera.from_mount((640, 480), MATRIX, [], [0.0, 0.0, 3.0, 0.0, np.pi / 2, 0.0])
    shown = largest_visible(camera, Rectangle(1.6, 3.2, -0.5, 0.5))
    assert (shown.y_min, shown.y_max) == (-0.5, 0.5)
    assert shown.x_min == 1.6
    assert 2.4 - 1.6 / CELLS <= shown.x_max <= 2.4 + 1e-9


@pytest.mark.parametrize("coarsest_m", [0.005, 0.02])
def test_fine_ground_is_where_a_pixel_covers_little_in_every_direction(coarsest_m):
    """The longest axis of the ellipse that a pixel's circle is on the ground, by its outline."""
    points = np.stack(np.meshgrid(np.linspace(0.4, 6.0, 40), np.linspace(-2, 2, 21)), axis=-1)
    angle = np.linspace(0.0, 2 * np.pi, 720)
    pixels = AHEAD.ground_to_pixels(points)
    round_each = pixels[..., None, :] + 0.01 * np.stack([np.cos(angle), np.sin(angle)], axis=-1)
    ellipses = AHEAD.pixels_to_ground(round_each)
    reach_m = np.linalg.norm(ellipses - points[..., None, :], axis=-1).max(axis=-1) / 0.01
    clear = AHEAD.in_image(pixels) & (np.abs(reach_m / coarsest_m - 1) > 0.01)
    assert clear.sum() > 100
    fine = is_visible(AHEAD, points, coarsest_m)
    np.testing.assert_array_equal(fine[clear], reach_m[clear] < coarsest_m)
    assert not fine[~AHEAD.in_image(pixels)].any()
