"""Pieces of one photograph, and what is alike at the borders of different ones."""

import cv2
import numpy as np
import pytest

from terrain.classification.photographs.pieces import pieces


def texture(rng, shape):
    """An image (rows, columns) of fine grains."""
    return np.clip(128 + 300 * cv2.GaussianBlur(rng.normal(size=shape), (0, 0), 2), 0, 255)


def with_bars(image):
    """Black above and below smooth terrain."""
    image = 128 + (image - 128) / 6
    image[:40] = image[-40:] = 0
    return image


def with_robot(image):
    """One dark bumper at the lower border, with a bright edge."""
    image[-40:] = 20
    image[-44:-40] = 250
    return image


def with_shade(image):
    """Darker to the corners."""
    rows, columns = np.ogrid[-1 : 1 : image.shape[0] * 1j, -1 : 1 : image.shape[1] * 1j]
    return image * (1 - 0.4 * (rows**2 + columns**2))


@pytest.fixture
def write(tmp_path):
    """Write images, and return the file of each as its own group."""

    def make(images):
        files = [tmp_path / f"{n:02d}.jpg" for n in range(len(images))]
        for file, image in zip(files, images, strict=True):
            cv2.imwrite(str(file), np.asarray(image).astype(np.uint8))
        return {file: str(file) for file in files}

    return make


@pytest.mark.parametrize("cut", ["beside", "below"])
def test_the_piece_that_goes_on_is_found(write, rng, cut):
    whole = texture(rng, (128, 384))
    first, second, third = (whole[:, at : at + 128] for at in (0, 128, 256))
    others = [texture(rng, (128, 128)) for _ in range(8)]
    images = [third, first, *others, second]
    groups = write(images if cut == "beside" else [image.T for image in images])
    files = list(groups)
    assert set(pieces(groups)) == {(files[1], files[-1]), (files[-1], files[0])}
    assert not list(pieces(dict.fromkeys(files, "one photograph")))


@pytest.mark.parametrize("alter", [np.copy, with_bars, with_robot, with_shade])
def test_other_scenes_do_not_go_on(write, rng, alter):
    groups = write([alter(texture(rng, (160, 160))) for _ in range(40)])
    assert not list(pieces(groups))


def test_flat_small_and_broken_files_go_on_in_none(write, rng, tmp_path):
    small = texture(rng, (60, 120))
    flat = np.full((128, 128), 90)
    groups = write([flat, flat, small[:, :60], small[:, 60:]])
    broken = tmp_path / "broken.jpg"
    broken.write_bytes(b"no image")
    assert not list(pieces({**groups, broken: "broken"}))
