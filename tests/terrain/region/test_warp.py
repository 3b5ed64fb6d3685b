"""The view from above, against ground that is painted through the camera by rays cast here."""

import cv2
import numpy as np
import pytest

from terrain.camera.camera import Camera
from terrain.region.region import Rectangle
from terrain.region.warp import ground_sampling_m, ground_view, pixel_view, view_shape

RECTANGLE = Rectangle(0.55, 0.95, -0.15, 0.2)


@pytest.fixture(scope="module")
def camera(world):
    return Camera.from_table(world.camera)


@pytest.fixture(scope="module")
def paint(world):
    """Image of the camera over ground whose grey is a function of x and y."""
    points = world.ground_seen(world.camera, 4)

    def paint_with(grey_at):
        x, y = np.moveaxis(np.nan_to_num(points, nan=1e3), -1, 0)
        return world.shrink(grey_at(x, y), 4)

    return paint_with


def slopes(x, y):
    """Smooth, brighter to the far left, with no symmetry."""
    return 120 + 50 * np.sin(9 * x + 2 * y) + 60 * np.tanh(4 * y) + 20 * np.cos(17 * y)


def cell_centres(rectangle, metres_per_pixel, rows, columns):
    """x and y of the middle of each pixel of a view whose first pixel is far left."""
    x = rectangle.x_max - metres_per_pixel * (np.arange(rows) + 0.5)
    y = rectangle.y_max - metres_per_pixel * (np.arange(columns) + 0.5)
    return np.meshgrid(x, y, indexing="ij")


@pytest.mark.parametrize("metres_per_pixel", [0.004, 0.01, 0.02])
def test_every_pixel_of_the_view_shows_its_own_ground(camera, paint, metres_per_pixel):
    """Place, scale and orientation at once: half a pixel off would make 3 grey levels or more."""
    view = ground_view(paint(slopes), camera, RECTANGLE, metres_per_pixel)
    rows, columns = round(0.4 / metres_per_pixel), int(0.35 / metres_per_pixel + 1e-9)
    assert view.shape == (rows, columns)
    expected = slopes(*cell_centres(RECTANGLE, metres_per_pixel, rows, columns))
    assert np.abs(view - expected).mean() < 0.7
    assert np.abs(view - expected).max() < 4


def test_a_chessboard_has_its_squares_where_they_were_painted(camera, paint):
    """Squares of 5 cm, and the one from (0.70, 0.05) to (0.75, 0.10) painted grey."""

    def board(x, y):
        white = (np.floor(x / 0.05) + np.floor(y / 0.05)) % 2 == 0
        marked = (x > 0.70) & (x < 0.75) & (y > 0.05) & (y < 0.10)
        return np.where(marked, 128.0, np.where(white, 220.0, 30.0))

    view = ground_view(paint(board), camera, RECTANGLE, 0.01)
    assert view.shape == (40, 35)
    squares = view.reshape(8, 5, 7, 5)[:, 1:4, :, 1:4].mean(axis=(1, 3))
    expected = board(*cell_centres(RECTANGLE, 0.05, 8, 7))
    assert expected[4, 2] == 128  # (0.95 - 0.75) / 0.05 = 4 squares down, (0.2 - 0.1) / 0.05 = 2
    np.testing.assert_allclose(squares, expected, atol=15)


def test_where_the_image_is_finer_it_is_averaged(camera, paint):
    """Stripes of 12 mm are two to a pixel of 24 mm: the true mean is flat, samples are not."""

    def stripes(x, y):
        return np.where((x + 0.002) % 0.012 < 0.006, 220.0, 20.0) + 0 * y

    near = Rectangle(0.35, 0.542, -0.12, 0.12)
    image = paint(stripes)
    view = ground_view(image, camera, near, 0.024)
    x, y = cell_centres(near, 0.024, *view.shape)
    u, v = np.moveaxis(camera.ground_to_pixels(np.stack([x, y], axis=-1)), -1, 0)
    samples = cv2.remap(image, u.astype(np.float32), v.astype(np.float32), cv2.INTER_LINEAR)
    assert samples.std() > 15
    assert view.std() < samples.std() / 3
    assert view.mean() == pytest.approx(120, abs=6)


def test_colour_is_warped_channel_by_channel(camera, paint):
    grey = paint(slopes)
    colour = np.stack([grey, 255 - grey, grey // 2], axis=-1)
    view = ground_view(colour, camera, RECTANGLE, 0.01)
    assert view.shape == (40, 35, 3)
    for channel in range(3):
        alone = ground_view(np.ascontiguousarray(colour[..., channel]), camera, RECTANGLE, 0.01)
        np.testing.assert_array_equal(view[..., channel], alone)


def test_sides_are_rounded_down_to_whole_pixels():
    assert view_shape(Rectangle(1.0, 1.3, -0.1, 0.25), 0.1) == (3, 3)
    assert view_shape(Rectangle(0.0, 0.3, 0.0, 0.1 * 3), 0.1) == (3, 3)  # 0.1 * 3 / 0.1 is 3.0...04
    assert view_shape(Rectangle(0.0, 0.05, 0.0, 0.3), 0.1) == (0, 3)


def test_the_pixel_view_is_the_raw_image_round_the_rectangle(world, camera):
    """Pixels that show ground of the rectangle span the crop, and no pixel is resampled."""
    v, u = np.indices((120, 160)).astype(np.uint8)
    crop = pixel_view(np.stack([u, v, v], axis=-1), camera, RECTANGLE)
    ground = world.ground_seen(world.camera)
    inside = (
        (ground[..., 0] >= RECTANGLE.x_min)
        & (ground[..., 0] <= RECTANGLE.x_max)
        & (ground[..., 1] >= RECTANGLE.y_min)
        & (ground[..., 1] <= RECTANGLE.y_max)
    )
    rows, columns = np.nonzero(inside)
    assert crop[0, 0, 1] <= rows.min() <= crop[0, 0, 1] + 2
    assert crop[-1, -1, 1] - 2 <= rows.max() <= crop[-1, -1, 1]
    assert crop[0, 0, 0] <= columns.min() <= crop[0, 0, 0] + 2
    assert crop[-1, -1, 0] - 2 <= columns.max() <= crop[-1, -1, 0]
    assert (np.diff(crop[..., 0].astype(int), axis=1) == 1).all()
    assert (np.diff(crop[..., 1].astype(int), axis=0) == 1).all()


def test_sampling_straight_down_is_height_over_focal_length():
    camera = Camera.from_mount(
        (640, 480), [[400, 0, 320], [0, 500, 240], [0, 0, 1]], [], [0, 0, 2, 0, np.pi / 2, 0]
    )
    finest, coarsest = ground_sampling_m(camera, Rectangle(-0.3, 0.3, -0.3, 0.3))
    assert finest == pytest.approx(2 / 500)
    assert coarsest == pytest.approx(2 / 400)


def test_sampling_at_forty_five_degrees_by_hand():
    """Height h, at x: depth (x + h) / sqrt 2; across it is depth / f, along depth^2 sqrt 2 / f h.

    v = f (x - h) / (x + h) upwards from the axis, so dv/dx = 2 f h / (x + h)^2.
    """
    h, f = 1.0, 400.0
    camera = Camera.from_mount(
        (640, 480), [[f, 0, 320], [0, f, 240], [0, 0, 1]], [], [0, 0, h, 0, np.pi / 4, 0]
    )
    rectangle = Rectangle(0.9, 1.3, -1e-6, 1e-6)
    finest, coarsest = ground_sampling_m(camera, rectangle)
    assert finest == pytest.approx((0.9 + h) / np.sqrt(2) / f, rel=2e-3)
    assert coarsest == pytest.approx((1.3 + h) ** 2 / (2 * f * h), rel=2e-3)


def test_sampling_is_known_where_the_image_of_the_ground_ends():
    """At a far corner the lens model may end just beyond the region."""
    camera = Camera.from_mount(
        (640, 480),
        [[250, 0, 320], [0, 250, 240], [0, 0, 1]],
        [-0.3, 0.0, 0.0, 0.0],
        [0, 0, 1.0, 0, np.pi / 2, 0],
    )
    limit = np.sqrt(1 / 0.9) - 1e-5  # r - 0.3 r^3 turns back at r^2 = 1 / 0.9
    side = limit / np.sqrt(2)
    assert np.isfinite(camera.ground_to_pixels([side, side])).all()
    assert np.isnan(camera.ground_to_pixels([side + 1e-3, side])).all()
    sampling = ground_sampling_m(camera, Rectangle(-side, side, -side, side))
    assert np.isfinite(sampling).all()


LENSES = {
    "none": [],
    "barrel": [-0.3, 0.1, 0.0, 0.0],
    "tangential": [-0.12, 0.05, 0.02, -0.03, 0.0],
    "rational": [0.2, -0.1, 0.001, 0.002, 0.01, 0.3, -0.05, 0.01],
    "prism and tilt": [-0.1, 0.02, 0.001, 0.0, 0, 0, 0, 0, 0.01, -0.02, 0.005, 0.01, 0.05, -0.08],
}


@pytest.mark.parametrize("lens", LENSES.values(), ids=LENSES)
@pytest.mark.parametrize("x_min", [0.4, 0.8], ids=["all in the image", "partly in the image"])
def test_each_cell_shows_what_lies_at_the_pixel_of_its_ground(lens, x_min):
    """The view of an image whose grey is u, then v, against `ground_to_pixels` of each cell."""
    matrix = [[300.0, 0.0, 127.0], [0.0, 310.0, 90.0], [0.0, 0.0, 1.0]]
    camera = Camera.from_mount((255, 200), matrix, lens, [0.1, 0.02, 0.6, 0.03, 0.8, -0.05])
    rectangle, scale = Rectangle(x_min, x_min + 0.5, -0.2, 0.2), 0.01
    fineness = int(np.ceil(scale / ground_sampling_m(camera, rectangle)[0]))
    cells = cell_centres(rectangle, scale / fineness, 50 * fineness, 40 * fineness)
    pixels = camera.ground_to_pixels(np.stack(cells, axis=-1))
    pixels = pixels.reshape(50, fineness, 40, fineness, 2)
    inside = camera.in_image(pixels).all(axis=(1, 3))
    expected = pixels.mean(axis=(1, 3))
    assert inside.any()
    greys = np.stack(np.meshgrid(np.arange(255), np.arange(200)), axis=-1).astype(np.uint8)
    for axis in (0, 1):
        view = ground_view(np.ascontiguousarray(greys[..., axis]), camera, rectangle, scale)
        off = np.abs(view[inside] - expected[inside][:, axis])
        assert off.max() < 1.1, lens  # each rounded to whole greys, twice
