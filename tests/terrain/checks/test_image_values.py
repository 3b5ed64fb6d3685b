"""Depth, exposure and blur of images."""

import cv2
import numpy as np
import pytest

from odometry.checks.findings.finding import Level
from terrain.checks.image_values import grey_of, image_values, values_of


def deep(bits):
    return lambda image: image.astype(np.uint16) * 257 >> (16 - bits)


@pytest.mark.parametrize(("bits", "name"), [(12, "images_12_bit"), (10, "images_few_bits")])
def test_few_bits_in_16(faulty, bits, name):
    faulty.images(deep(bits), ".png")
    finding = faulty.found()[name]
    assert finding.level is Level.WARNING
    assert f"{bits}-bit data" in finding.cause
    assert f"by {2 ** (16 - bits)}" in finding.remedy
    assert "images_dark" not in faulty.found()  # which follows from it


def test_16_bits_are_a_note(faulty):
    faulty.images(deep(16), ".png")
    found = faulty.found()
    assert list(found) == ["images_16_bit"]
    assert found["images_16_bit"].level is Level.NOTE


EXPOSURES = {
    "images_dark": lambda image: image // 40,
    "images_bright": lambda image: np.minimum(image.astype(int) + 160, 255).astype(np.uint8),
    "images_flat": lambda image: np.full_like(image, 128),
}


@pytest.mark.parametrize("name", EXPOSURES)
def test_exposure(faulty, name):
    faulty.images(EXPOSURES[name], ".png")
    found = faulty.found()
    assert name in found
    assert found[name].level is Level.WARNING


def test_a_bright_sky_is_not_overexposed(faulty):
    """The region ahead lies in the lower half; the upper 60 % of the image are white."""

    def with_sky(image):
        image[:50] = 255
        return image

    faulty.settings(camera={"mount": [0.2, 0.0, 0.55, 0.0, 0.5, 0.0]})
    faulty.images(with_sky)
    assert faulty.found() == {}


def test_blur_is_a_note(faulty):
    rng = np.random.default_rng(1)
    large = cv2.GaussianBlur(rng.normal(0, 1, (500, 500)), (0, 0), 12)
    large = np.clip(128 + 40 * large / large.std(), 0, 255).astype(np.uint8)

    def crop(_):
        row, column = rng.integers(100, 240, 2)
        return large[row : row + 120, column : column + 160]

    faulty.images(crop, ".png")
    found = faulty.found()
    assert found["images_blurred"].level is Level.NOTE
    assert "cannot be distinguished" in found["images_blurred"].cause


def test_real_frames_in_focus_are_not_odd(shared_data):
    """Six megapixels of two robots' cameras as they saw the ground."""
    files = sorted((shared_data / "camera-frames").rglob("*.jpg"))
    assert len(files) == 4
    values = []
    for file in files:
        pixels = cv2.imread(str(file), cv2.IMREAD_UNCHANGED)
        values.append(values_of(pixels, grey_of(pixels)[pixels.shape[0] // 2 :]))
    assert list(image_values(values)) == []
