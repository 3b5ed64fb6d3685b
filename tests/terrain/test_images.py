"""Grey by the equation, and files of every kind that is read."""

import struct
import tracemalloc
import zlib

import cv2
import numpy as np
import pytest
from hypothesis import given
from hypothesis.extra.numpy import array_shapes, arrays

from terrain.errors import ImageError
from terrain.image_size import is_whole, stated_size
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


@pytest.mark.parametrize("green", range(0, 256, 15))
def test_no_colour_is_rounded_the_wrong_way(green):
    """Sums are made of floats; exact ones lie a hundredth apart."""
    red, blue = np.meshgrid(np.arange(256), np.arange(256))
    image = np.stack([red, np.full_like(red, green), blue], axis=-1).astype(np.uint8)
    np.testing.assert_array_equal(to_grey(image), (30 * red + 59 * green + 11 * blue + 50) // 100)


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


def png_of(width, height, rows_held=None):
    """A PNG that states a size and holds rows of black, packed: few bytes make a large image."""
    rows = zlib.compressobj(9)
    packed = [rows.compress(bytes(width + 1)) for _ in range(rows_held or height)]
    data = b"".join(packed) + rows.flush()
    header = struct.pack(">IIBBBBB", width, height, 8, 0, 0, 0, 0)
    chunks = ((b"IHDR", header), (b"IDAT", data), (b"IEND", b""))
    packed = [
        struct.pack(">I", len(content)) + kind + content + zlib.crc32(kind + content).to_bytes(4)
        for kind, content in chunks
    ]
    return b"\x89PNG\r\n\x1a\n" + b"".join(packed)


def test_the_size_is_read_before_the_image(tmp_path):
    """Nothing of the size of the decoded image may be allocated."""
    file = tmp_path / "photo.png"
    file.write_bytes(png_of(30000, 30000, rows_held=100))
    tracemalloc.start()
    with pytest.raises(ImageError, match="30000 x 30000 pixels, expected 1 to 64000000"):
        read_image(file)
    assert tracemalloc.get_traced_memory()[1] < 20e6
    tracemalloc.stop()
    file.write_bytes(png_of(40, 30))
    assert read_image(file).shape == (30, 40)
    file.write_bytes(png_of(0, 30))
    with pytest.raises(ImageError, match="0 x 30 pixels"):
        read_image(file)


@pytest.mark.parametrize("suffix", ["png", "jpg", "bmp", "tiff"])
def test_the_stated_size_is_that_of_the_image(suffix, colour):
    encoded = cv2.imencode(f".{suffix}", colour)[1].tobytes()
    assert stated_size(encoded) == (17, 12)
    for length in range(26):
        assert stated_size(encoded[:length]) in (None, (17, 12))


def test_a_jpeg_with_a_thumbnail_states_its_own_size(colour):
    """The thumbnail is a whole JPEG of another size, in a segment before the frame header."""
    thumbnail = cv2.imencode(".jpg", colour[:5, :4])[1].tobytes()
    segment = b"\xff\xe1" + struct.pack(">H", len(thumbnail) + 8) + b"Exif\0\0" + thumbnail
    encoded = cv2.imencode(".jpg", colour)[1].tobytes()
    with_thumbnail = encoded[:2] + segment + b"\xff" + encoded[2:]
    assert stated_size(with_thumbnail) == (17, 12)
    assert is_whole(with_thumbnail)
    assert not is_whole(with_thumbnail[:-2])


@pytest.mark.parametrize("suffix", ["png", "jpg"])
def test_an_image_that_was_cut_off_is_refused(tmp_path, colour, suffix):
    """OpenCV fills the rest of a JPEG with grey, and says so to nobody."""
    encoded = cv2.imencode(f".{suffix}", cv2.resize(colour, (170, 120)))[1].tobytes()
    file = tmp_path / f"photo.{suffix}"
    for share in (0.5, 0.9, 0.99):
        file.write_bytes(encoded[: int(share * len(encoded))])
        with pytest.raises(ImageError, match="cut off"):
            read_image(file)
    file.write_bytes(encoded + b"something of the camera's own")
    assert read_image(file).shape == (120, 170, 3)


def test_of_a_video_frames_are_asked_for(tmp_path):
    (tmp_path / "walk.mp4").write_bytes(b"no image")
    with pytest.raises(ImageError, match=r"walk\.mp4: 8 bytes .* of a video give frames"):
        read_image(tmp_path / "walk.mp4")
