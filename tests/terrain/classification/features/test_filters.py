import cv2
import numpy as np
import pytest

from terrain.classification.features.filters import (
    MOST_KEPT_PX,
    Scales,
    band_pass,
    blur,
    coherence,
    gradient_magnitude,
    gradient_orientation,
    latest_scales,
    local_contrast,
    red_green,
    reduced,
    yellow_blue,
)

INSIDE = (slice(24, -24), slice(24, -24))
ROWS, COLUMNS = np.mgrid[0:96, 0:96].astype(np.float32)
FILTERS = [
    band_pass(1.0),
    coherence(1.4),
    gradient_magnitude(1.4),
    gradient_orientation(1.4),
    local_contrast(5.6),
]


def ramp(angle, slope=0.8):
    return (120 + slope * (np.cos(angle) * (COLUMNS - 48) + np.sin(angle) * (ROWS - 48))).astype(
        np.float32
    )


def test_a_reduced_image_holds_the_means_of_squares(rng):
    grey = rng.integers(0, 256, (32, 48)).astype(np.float32)
    means = grey.reshape(8, 4, 12, 4).mean(axis=(1, 3))
    assert np.abs(reduced(4)(Scales(grey)) - means).max() <= 0.5 + 1e-4
    np.testing.assert_array_equal(reduced(1)(Scales(grey)), grey)


@pytest.mark.parametrize("angle", [0.0, 0.6, 1.5, 2.5])
def test_on_a_ramp_every_filter_has_a_closed_form(angle):
    grey = ramp(angle)
    np.testing.assert_array_equal(band_pass(2.0)(Scales(grey))[INSIDE], 128)
    np.testing.assert_array_equal(local_contrast(2.0)(Scales(grey))[INSIDE], 128)
    magnitude = 90 + 40 * np.log(0.8 + 0.2)
    assert np.abs(gradient_magnitude(1.4)(Scales(grey))[INSIDE] - magnitude).max() <= 0.6
    orientation = gradient_orientation(1.4)(Scales(grey))[INSIDE] * (np.pi / 255)
    assert np.abs(np.exp(2j * orientation) - np.exp(2j * angle)).max() < 0.03
    assert coherence(1.4)(Scales(grey))[INSIDE].min() == 255


def test_a_wave_passes_the_band_with_the_gain_of_its_gaussians():
    frequency = 2 * np.pi / 12
    grey = (128 + 10 * np.sin(frequency * COLUMNS)).astype(np.float32)
    gain = np.exp(-((2 * frequency) ** 2) / 2) - np.exp(-((4 * frequency) ** 2) / 2)
    expected = 128 + 8 * 10 * gain * np.sin(frequency * COLUMNS)
    assert np.abs(band_pass(2.0)(Scales(grey)) - expected)[INSIDE].max() < 1.5


@pytest.mark.parametrize("apply", FILTERS)
def test_no_filter_sees_brightness(apply, rng):
    grey = rng.integers(40, 160, (64, 64)).astype(np.float32)
    changed = np.abs(apply(Scales(grey + 64)).astype(int) - apply(Scales(grey)).astype(int))
    assert (np.minimum(changed, 255 - changed) <= 1).mean() > 0.999


def test_orientation_ignores_contrast_and_the_others_grow_with_it(rng):
    grey = rng.integers(0, 64, (64, 64)).astype(np.float32)
    np.testing.assert_array_equal(
        gradient_orientation(1.4)(Scales(4 * grey)), gradient_orientation(1.4)(Scales(grey))
    )
    assert (
        gradient_magnitude(1.4)(Scales(4 * grey)).mean()
        > gradient_magnitude(1.4)(Scales(grey)).mean() + 20
    )
    assert band_pass(1.0)(Scales(4 * grey)).std() > 2 * band_pass(1.0)(Scales(grey)).std()


def test_coherence_distinguishes_lines_from_grains(rng):
    lines = (128 + 60 * np.sin(COLUMNS / 2)).astype(np.float32)
    grains = rng.normal(128, 40, (96, 96)).astype(np.float32)
    assert coherence(1.4)(Scales(lines))[INSIDE].min() > 250
    assert coherence(1.4)(Scales(grains)).mean() < 150


def test_colour_differences_by_hand():
    image = np.array([[[100, 80, 50], [10, 250, 128], [77, 77, 77]]], dtype=np.uint8)
    np.testing.assert_array_equal(red_green(image), [[168, 0, 128]])
    np.testing.assert_array_equal(yellow_blue(image), [[208, 132, 128]])


@pytest.mark.parametrize("apply", [*FILTERS, reduced(4)])
@pytest.mark.parametrize("shape", [(1, 1), (2, 3), (40, 8)])
def test_small_and_flat_images_give_bytes(apply, shape):
    copy = apply(Scales(np.full(shape, 128, np.uint8)))
    assert copy.dtype == np.uint8
    assert len(np.unique(copy)) == 1


def test_means_between_two_greys_are_rounded_to_the_even_one():
    grey = np.repeat(np.array([[0, 1, 1, 2, 254, 255]], np.uint8), 2, axis=0)
    np.testing.assert_array_equal(reduced(2)(Scales(grey)), [[0, 2, 254]])


@pytest.mark.parametrize("shape", [(96, 96), (128, 200), (97, 131)])
@pytest.mark.parametrize("sigma_px", [11.2, 16.0])
def test_a_wide_blur_is_nearly_the_gaussian(shape, sigma_px, rng):
    grey = cv2.GaussianBlur(rng.uniform(0, 255, shape).astype(np.float32), (0, 0), 1.0)
    grey += np.linspace(-40, 40, shape[1], dtype=np.float32)
    off = blur(grey, sigma_px) - cv2.GaussianBlur(grey, (0, 0), sigma_px)
    assert np.sqrt(np.mean(off[INSIDE] ** 2)) < 0.1
    assert np.abs(off).max() < 1.0


@pytest.mark.parametrize(("shape", "sigma_px"), [((31, 200), 16.0), ((96, 96), 8.0)])
def test_a_blur_that_is_not_wide_and_one_of_a_small_patch_are_the_gaussian(shape, sigma_px, rng):
    grey = rng.uniform(0, 255, shape).astype(np.float32)
    expected = cv2.GaussianBlur(grey, (0, 0), sigma_px)
    np.testing.assert_array_equal(blur(grey, sigma_px), expected)


def test_scales_of_a_patch_are_kept_for_the_same_patch_again_and_large_ones_are_not(rng):
    grey, other = rng.integers(0, 256, (2, 96, 96), dtype=np.uint8)
    kept = latest_scales(grey)
    assert latest_scales(grey.copy()) is kept
    assert latest_scales(other) is not kept
    assert latest_scales(grey.reshape(48, 192)) is not kept
    np.testing.assert_array_equal(kept.blurred(1.4), Scales(grey).blurred(1.4))
    large = np.zeros((MOST_KEPT_PX // 64, 65), np.uint8)
    assert latest_scales(large) is not latest_scales(large)
