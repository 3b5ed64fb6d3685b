"""Thresholds against exhaustive search, scikit-image, and cases done by hand."""

from fractions import Fraction
from itertools import combinations, pairwise

import numpy as np
import pytest
from hypothesis import assume, given, settings
from hypothesis import strategies as st
from skimage.data import brick, grass, gravel
from skimage.filters import threshold_multiotsu

from terrain.texture.otsu import STRIP, multilevel_otsu, recursive_otsu


def histogram_of(pixels_by_grey):
    histogram = np.zeros(256)
    histogram[list(pixels_by_grey)] = list(pixels_by_grey.values())
    return histogram


def between_class_sum(pixels_by_grey, thresholds):
    """Sum over classes of S^2 / W, as an exact fraction."""
    bounds = [-1, *thresholds, 255]
    total = Fraction(0)
    for low, high in pairwise(bounds):
        members = {g: n for g, n in pixels_by_grey.items() if low < g <= high}
        pixels = sum(members.values())
        total += Fraction(sum(g * n for g, n in members.items()) ** 2, pixels)
    return total


@settings(max_examples=60, deadline=None)
@given(
    st.dictionaries(st.integers(0, 255), st.integers(1, 40), min_size=5, max_size=9),
    st.integers(1, 4),
)
def test_exact_thresholds_are_the_best_and_settle_ties_as_stated(pixels_by_grey, n_thresholds):
    greys = sorted(pixels_by_grey)[:-1]
    sets = list(combinations(greys, n_thresholds))
    scores = {chosen: between_class_sum(pixels_by_grey, chosen) for chosen in sets}
    best = [chosen for chosen in sets if scores[chosen] == max(scores.values())]

    thresholds = multilevel_otsu(histogram_of(pixels_by_grey), n_thresholds)

    assert tuple(thresholds) == min(best, key=lambda chosen: chosen[::-1])


def test_ties_take_the_smallest_last_threshold():
    symmetric = histogram_of({10: 5, 20: 5, 30: 5})
    np.testing.assert_array_equal(multilevel_otsu(symmetric, 1), [10.0])


def test_rounding_does_not_settle_ties():
    """A symmetric histogram: the mirrored thresholds (75, 152) are exactly as good."""
    pixels = {33: 5, 39: 14, 48: 12, 75: 1, 125: 1, 152: 12, 161: 14, 167: 5}
    assert between_class_sum(pixels, (39, 75)) == between_class_sum(pixels, (75, 152))
    np.testing.assert_array_equal(multilevel_otsu(histogram_of(pixels), 2), [39.0, 75.0])


@pytest.mark.parametrize("width", range(STRIP - 2, STRIP + 3))
def test_heaps_are_distinguished_wherever_the_strips_of_the_programme_end(width):
    pixels = dict.fromkeys([*range(width), *range(120, 160), *range(215, 255)], 3)
    thresholds = multilevel_otsu(histogram_of(pixels), 2)
    np.testing.assert_array_equal(thresholds, [width - 1.0, 159.0])


@pytest.mark.parametrize("photo", [brick, grass, gravel])
@pytest.mark.parametrize("n_thresholds", [1, 2])
def test_exact_thresholds_agree_with_scikit_image(photo, n_thresholds):
    image = photo()[:120, :160]
    theirs = threshold_multiotsu(image, classes=n_thresholds + 1)
    ours = multilevel_otsu(np.bincount(image.ravel(), minlength=256), n_thresholds)
    np.testing.assert_array_equal(ours, theirs)


@pytest.mark.parametrize(
    ("pixels_by_grey", "expected"),
    [
        ({7: 100}, [7, 7, 7, 7]),
        ({0: 3, 255: 1}, [0, 255, 255, 255]),
        ({1: 1, 2: 1, 3: 1, 4: 1}, [1, 2, 3, 4]),
        ({1: 1, 2: 1, 3: 1, 4: 1, 5: 1}, [1, 2, 3, 4]),
    ],
)
def test_too_few_greys_repeat_the_largest(pixels_by_grey, expected):
    thresholds = multilevel_otsu(histogram_of(pixels_by_grey), 4)
    np.testing.assert_array_equal(thresholds, expected)


@given(st.lists(st.integers(0, 100), min_size=40, max_size=200), st.integers(0, 55))
def test_brighter_images_have_brighter_thresholds(greys, offset):
    histogram = np.bincount(greys, minlength=256)
    n_thresholds = min(4, np.count_nonzero(histogram))
    brighter = multilevel_otsu(np.roll(histogram, offset), n_thresholds)
    np.testing.assert_array_equal(brighter, multilevel_otsu(histogram, n_thresholds) + offset)


def test_recursive_thresholds_of_two_heaps_by_hand():
    """Any split between 10 and 20 is as good: bins 11 to 20 of the published code, mean 15.5."""
    two_heaps = histogram_of({10: 4, 20: 4})
    np.testing.assert_allclose(recursive_otsu(two_heaps, 1), [(1 + 15.5) * 255 / 256])


@settings(max_examples=60)
@given(st.dictionaries(st.integers(0, 255), st.integers(1, 40), min_size=2, max_size=9))
def test_one_recursive_threshold_is_the_middle_of_the_best_ones(pixels_by_grey):
    """Bins count from 1, and the search begins at bin 1: two more than the grey."""
    greys = range(min(pixels_by_grey), max(pixels_by_grey))
    sums = [between_class_sum(pixels_by_grey, [grey]) for grey in greys]
    best = [grey for grey, of in zip(greys, sums, strict=True) if of == max(sums)]
    assume(best[-1] - best[0] == len(best) - 1)  # floats settle ties between other cuts
    (found,) = recursive_otsu(histogram_of(pixels_by_grey), 1)
    assert found * 256 / 255 - 2 == pytest.approx(np.mean(best), abs=1e-9)


def test_recursive_thresholds_of_a_flat_image_follow_the_published_code():
    flat = histogram_of({90: 50})
    np.testing.assert_allclose(recursive_otsu(flat, 4) * 256 / 255, [0.0, 0.0, 1.0, 2.0])
