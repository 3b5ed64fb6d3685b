"""Grey by the equation, and files of every kind that is read."""

import cv2
import numpy as np
import pytest
from hypothesis import given
from hypothesis.extra.numpy import array_shapes, arrays

from terrain.errors import ImageError
from terrain.images import read_image, to_bytes, to_grey

colour_images = arrays(
    np.uint8, array_shapes(min_dims=2, max_dims=2, max_side=6).map(lambda shape: (*shape, 3))
)


@pytest.fixture
def colour():
    return np.random.default_rng(3).integers(0, 256, (12, 17, 3), np.uint8)


@given(colour_images)
def test_grey_is_the_weighted_sum_in_rgb_order(image):
    for pixel, grey in zip(image.reshape(-1, 3), to_grey(image).ravel(), strict=True):
        red, green, blue = (int(value) for value in pixel)
        assert grey == (30 * red + 59 * green + 11 * blue + 50) // 100


def test_red_green_and_blue_weigh_as_in_the_paper():
    primaries = 200 * np.eye(3, dtype=np.uint8)[None]
    np.testing.assert_array_equal(to_grey(primaries), [[60, 118, 22]])


def test_kinds_of_value_become_bytes():
    np.testing.assert_array_equal(to_bytes(np.array([[False, True]])), [[0, 255]])
    np.testing.assert_array_equal(
        to_bytes(np.array([[0, 128, 129, 65535]], np.uint16)), [[0, 0, 1, 255]]
    )
    np.testing.assert_array_equal(to_bytes(np.array([[0.0, 0.25, 0.5, 1.0]])), [[0, 64, 128, 255]])


@pytest.mark.parametrize("value", [np.nan, np.inf, -np.inf])
def test_values_that_are_not_finite_are_refused(value):
    with pytest.raises(ImageError, match="NaN or inf"):
        to_grey(np.array([[0.5, value]]))


@pytest.mark.parametrize("value", [-0.1, 1.1, 255.0])
def test_floats_outside_0_to_1_are_refused(value):
    with pytest.raises(ImageError, match="in 0 to 1, this one in"):
        to_grey(np.array([[0.5, value]]))


def test_a_colour_file_is_read_in_rgb_order(tmp_path, colour):
    cv2.imwrite(str(tmp_path / "photo.png"), colour[..., ::-1])
    image = read_image(tmp_path / "photo.png")
    np.testing.assert_array_equal(image, colour, strict=True)
    assert image.flags.c_contiguous


def test_alpha_is_dropped(tmp_path, colour):
    rgba = np.dstack((colour, colour[..., 0]))
    cv2.imwrite(str(tmp_path / "photo.png"), rgba[..., [2, 1, 0, 3]])
    np.testing.assert_array_equal(read_image(tmp_path / "photo.png"), colour, strict=True)


def test_a_grey_file_stays_grey(tmp_path, colour):
    cv2.imwrite(str(tmp_path / "photo.png"), colour[..., 0])
    np.testing.assert_array_equal(read_image(tmp_path / "photo.png"), colour[..., 0], strict=True)


def test_sixteen_bits_become_eight(tmp_path, colour):
    cv2.imwrite(str(tmp_path / "photo.png"), colour[..., 0] * np.uint16(257))
    np.testing.assert_array_equal(read_image(tmp_path / "photo.png"), colour[..., 0], strict=True)


@pytest.mark.parametrize("content", [b"", b"not an image"])
def test_a_file_that_is_no_image_is_named(tmp_path, content):
    path = tmp_path / "photo.jpg"
    path.write_bytes(content)
    with pytest.raises(ImageError, match=r"photo\.jpg: \d+ bytes that do not decode"):
        read_image(path)


def test_a_missing_file_is_named(tmp_path):
    with pytest.raises(ImageError, match=r"nowhere\.png: cannot be read: No such file"):
        read_image(tmp_path / "nowhere.png")


def test_a_file_of_another_kind_of_value_is_named(tmp_path):
    path = tmp_path / "depth.tiff"
    cv2.imwrite(str(path), np.full((4, 4), 7.0, np.float32))
    with pytest.raises(ImageError, match=r"depth\.tiff: a float image has values in 0 to 1"):
        read_image(path)
