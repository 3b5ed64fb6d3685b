"""Whole features against the equations written as loops, and by relation."""

import math

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from hypothesis.extra.numpy import array_shapes, arrays

from odometry.errors import ConfigError
from terrain.errors import ImageError
from terrain.texture import feature_names, sfta
from terrain.texture.otsu import multilevel_otsu

VARIANTS = ("chen2023", "costa2012")
few_greys = st.sampled_from([0, 3, 60, 61, 140, 200, 254, 255])
small_images = arrays(
    np.uint8, array_shapes(min_dims=2, max_dims=2, max_side=9), elements=few_greys
)


def features_by_equations(image, n_thresholds):
    """Eq. 19 to 21 for one binary image after the other; thresholds tested elsewhere."""
    thresholds = multilevel_otsu(np.bincount(image.ravel(), minlength=256), n_thresholds)
    upper = [*thresholds[1:], 255]
    bands = [(t, 255) for t in thresholds] + list(zip(thresholds, upper, strict=True))
    features = []
    for low, high in bands:
        binary = (image > low) & (image <= high)
        features += [dimension_by_definition(binary), binary.sum()]
        features.append(image[binary].mean() if binary.any() else 0.0)
    return features


def dimension_by_definition(binary):
    border = [
        (r, c)
        for r, c in np.argwhere(binary)
        if not binary[max(r - 1, 0) : r + 2, max(c - 1, 0) : c + 2].all()
    ]
    sizes = [2**k for k in range(math.ceil(math.log2(max(binary.shape))) + 1)]
    if not border or len(sizes) == 1:
        return 0.0
    counts = [len({(r // size, c // size) for r, c in border}) for size in sizes]
    return np.polyfit(-np.log(sizes), np.log(counts), 1)[0]


@settings(deadline=None, max_examples=60)
@given(small_images, st.integers(1, 6))
def test_features_are_those_of_the_equations(image, n_thresholds):
    np.testing.assert_allclose(
        sfta(image, n_thresholds), features_by_equations(image, n_thresholds), atol=1e-12
    )


@settings(deadline=None)
@given(small_images, st.integers(1, 9), st.sampled_from(VARIANTS))
def test_features_are_finite_and_named(image, n_thresholds, variant):
    features = sfta(image, n_thresholds, variant)
    assert np.isfinite(features).all()
    assert len(features) == len(feature_names(n_thresholds, variant))
    dimensions, counts, means = features.reshape(-1, 3).T
    assert ((dimensions >= 0.0) & (dimensions <= 2.0)).all()
    assert ((counts >= 0) & (counts <= image.size)).all()
    assert ((means >= 0.0) & (means <= 255.0)).all()


@given(arrays(np.uint8, array_shapes(min_dims=2, max_dims=2, max_side=12)), st.integers(1, 255))
def test_an_offset_of_grey_moves_only_the_means(image, offset):
    darker = image % (256 - offset)
    brighter = darker + np.uint8(offset)
    dark, bright = sfta(darker).reshape(-1, 3), sfta(brighter).reshape(-1, 3)
    np.testing.assert_array_equal(bright[:, :2], dark[:, :2])
    occupied = dark[:, 1] > 0
    np.testing.assert_allclose(bright[occupied, 2], dark[occupied, 2] + offset, rtol=1e-12)


@given(small_images, st.sampled_from(VARIANTS))
def test_transposing_changes_nothing(image, variant):
    np.testing.assert_array_equal(sfta(image, variant=variant), sfta(image.T, variant=variant))


@given(small_images, st.sampled_from(VARIANTS))
def test_mirroring_keeps_counts_and_means(image, variant):
    """Dimensions may change: boxes start at the top left pixel."""
    features, mirrored = (sfta(i, variant=variant).reshape(-1, 3) for i in (image, image[:, ::-1]))
    np.testing.assert_array_equal(mirrored[:, 1:], features[:, 1:])


def test_the_first_images_of_many_thresholds_use_several_bytes():
    """n_t = 40 needs ten bytes a pixel: the upper images shrink as their thresholds rise."""
    rng = np.random.default_rng(2)
    counts = sfta(rng.integers(0, 256, (30, 40), np.uint8), 40).reshape(-1, 3)[:, 1]
    assert (np.diff(counts[:40]) < 0).all()
    assert counts[40:].sum() == counts[0]


@pytest.mark.parametrize("variant", VARIANTS)
@pytest.mark.parametrize("grey", [0, 128, 255])
def test_a_flat_image_has_no_texture(grey, variant):
    features = sfta(np.full((40, 30), grey, np.uint8), variant=variant)
    np.testing.assert_array_equal(features, 0.0)


def test_two_values_fill_the_first_image_and_its_band():
    image = np.zeros((16, 16), np.uint8)
    image[4:12, 4:12] = 90
    occupied = sfta(image).reshape(-1, 3)[:, 1]
    np.testing.assert_array_equal(occupied, [64, 0, 0, 0, 64, 0, 0, 0])


def test_alpha_kind_and_colour_are_brought_to_grey():
    rng = np.random.default_rng(8)
    grey = rng.integers(0, 256, (20, 24), np.uint8)
    expected = sfta(grey)
    colour = np.repeat(grey[..., None], 3, axis=2)
    alpha = rng.integers(0, 256, (20, 24, 1), np.uint8)
    alike = [
        colour,
        np.concatenate((colour, alpha), axis=2),
        grey[..., None],
        grey * np.uint16(257),
        grey / 255.0,
        (grey / 255.0).astype(np.float32),
        np.asfortranarray(grey),
        np.concatenate((grey, grey), axis=1)[::-1, :24][::-1],
    ]
    for image in alike:
        np.testing.assert_array_equal(sfta(image), expected)


def test_a_boolean_image_has_two_values():
    mask = np.eye(9, dtype=bool)
    np.testing.assert_array_equal(sfta(mask), sfta(mask * np.uint8(255)))


@pytest.mark.parametrize(
    ("image", "message"),
    [
        (np.zeros((0, 5), np.uint8), "at least one pixel"),
        (np.zeros(5, np.uint8), r"not \(5,\)"),
        (np.zeros((3, 3, 2), np.uint8), r"not \(3, 3, 2\)"),
        (np.full((3, 3), np.nan), "NaN"),
        (np.full((3, 3), 37.5), "37.5 to 37.5"),
        (np.zeros((3, 3), np.int32), "int32"),
    ],
)
def test_what_is_no_image_is_refused(image, message):
    with pytest.raises(ImageError, match=message):
        sfta(image)


@pytest.mark.parametrize("n_thresholds", [0, 256, -1, 2.0, "4", None])
def test_a_wrong_number_of_thresholds_is_refused(n_thresholds):
    with pytest.raises(ConfigError, match="whole number from 1 to 255"):
        sfta(np.zeros((3, 3), np.uint8), n_thresholds)


def test_an_unknown_variant_is_refused_with_the_known_ones():
    with pytest.raises(ConfigError, match="chen2023, costa2012, not 'sfta'"):
        sfta(np.zeros((3, 3), np.uint8), variant="sfta")
