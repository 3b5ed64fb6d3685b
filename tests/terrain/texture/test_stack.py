"""Many images at once against one after the other, and bands against whole images."""

import threading

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from hypothesis.extra.numpy import arrays

from terrain.texture import multilevel_otsu, region_borders, sfta
from terrain.texture import stack as stack_file
from terrain.texture.borders import _KEPT, MOST_SHAPES, kept
from terrain.texture.coarse_otsu import FEW, coarse_otsu
from terrain.texture.stack import stack_features
from terrain.texture.ttbd import VARIANTS


def one_by_one(stack, variant, n_thresholds=4):
    return np.stack([sfta(image, n_thresholds, variant) for image in stack])


@pytest.mark.parametrize("variant", VARIANTS)
@pytest.mark.parametrize("shape", [(1, 1), (1, 7), (16, 16), (31, 45)])
@pytest.mark.parametrize("n_thresholds", [1, 4, 9])
def test_a_stack_has_the_features_of_its_images(variant, shape, n_thresholds, rng):
    stack = rng.integers(0, 256, (5, *shape), dtype=np.uint8)
    stack[2] = 77
    found = stack_features(stack, n_thresholds, VARIANTS[variant])
    np.testing.assert_array_equal(found, one_by_one(stack, variant, n_thresholds), strict=True)


@pytest.mark.parametrize("variant", VARIANTS)
@pytest.mark.parametrize("band", [1, 90, 500, 3000])
def test_bands_change_nothing(variant, band, rng, monkeypatch):
    """Less than a row, a few rows, most of an image, and two images of three."""
    stack = rng.integers(0, 256, (3, 37, 41), dtype=np.uint8)
    whole = one_by_one(stack, variant)
    monkeypatch.setattr(stack_file, "BAND", band)
    np.testing.assert_array_equal(stack_features(stack, 4, VARIANTS[variant]), whole)


def test_an_answer_stays_when_the_next_image_comes(rng):
    """Bytes are kept from image to image, not what is given away."""
    first, second = rng.integers(0, 256, (2, 20, 20), dtype=np.uint8)
    borders = region_borders(first)
    before = borders.copy()
    region_borders(second)
    np.testing.assert_array_equal(borders, before)


def test_threads_do_not_share_what_is_kept(rng):
    images = rng.integers(0, 256, (40, 64, 64), dtype=np.uint8)
    expected, found = one_by_one(images, "chen2023"), {}

    def work(of):
        found[of] = one_by_one(images[of::2], "chen2023")

    threads = [threading.Thread(target=work, args=(of,)) for of in range(2)]
    for thread in threads:
        thread.start()
    for thread in threads:
        thread.join()
    for of, rows in found.items():
        np.testing.assert_array_equal(rows, expected[of::2])


few_pixels = st.sampled_from([0, 0, 0, 1, 2, 5, 5, 300])


@settings(max_examples=60)
@given(arrays(np.float64, (5, 256), elements=few_pixels), st.integers(1, 6))
def test_thresholds_in_bins_are_those_of_the_binned_histogram(histograms, n_thresholds):
    """Enough of them for the stack; one with a single grey goes one by one."""
    histograms[0] = 0.0
    histograms[0, 40] = 9.0
    histograms = np.concatenate([histograms, histograms[:, ::-1], np.roll(histograms, 37, axis=1)])
    assert len(histograms) > FEW
    for n_bins in (64, 16):
        binned = np.zeros((len(histograms), 256))
        binned[:, :n_bins] = histograms.reshape(len(histograms), n_bins, -1).sum(axis=2)
        width = 256 // n_bins
        expected = [
            multilevel_otsu(of, n_thresholds) * width + width - 1 for of in binned if of.any()
        ]
        some = histograms[histograms.any(axis=1)]
        np.testing.assert_array_equal(coarse_otsu(some, n_thresholds, n_bins), expected)


def test_kept_bytes_are_the_same_ones_and_of_no_more_shapes_than_are_remembered():
    small, large = kept("a test", (2, 3)), kept("a test", (4, 5))
    assert small.shape == (2, 3)
    assert kept("a test", (4, 5)) is large
    assert np.shares_memory(kept("a test", (2, 3)), large)
    assert not np.shares_memory(kept("another test", (4, 5)), large)
    for side in range(3 * MOST_SHAPES, 0, -1):  # the buffer does not grow
        kept("a test", (1, side))
    assert len(_KEPT.views) <= MOST_SHAPES
