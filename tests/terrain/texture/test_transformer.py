"""The transformer is the function, image by image."""

import numpy as np
import pytest

from terrain.errors import ImageError
from terrain.texture import SFTA, sfta


@pytest.fixture
def photos():
    return np.random.default_rng(4).integers(0, 256, (3, 20, 30, 3), np.uint8)


@pytest.mark.parametrize("variant", ["chen2023", "costa2012"])
def test_rows_are_the_features_of_the_images(photos, variant):
    rows = SFTA(n_thresholds=3, variant=variant).fit_transform(photos)
    np.testing.assert_array_equal(rows, [sfta(photo, 3, variant) for photo in photos])


def test_images_in_a_list_may_differ_in_size(photos):
    mixed = [photos[0], photos[1, :7, :9], photos[2, ..., 0]]
    rows = SFTA().transform(mixed)
    np.testing.assert_array_equal(rows, [sfta(image) for image in mixed])


def test_names_follow_the_order_of_the_paper():
    names = SFTA(n_thresholds=2).get_feature_names_out()
    assert " ".join(names) == "D1 C1 G1 D2 C2 G2 D3 C3 G3 D4 C4 G4"
    assert SFTA(n_thresholds=2, variant="costa2012").get_feature_names_out()[-1] == "G3"


@pytest.mark.parametrize("images", [[], np.zeros((0, 4, 4), np.uint8), np.zeros((4, 4), np.uint8)])
@pytest.mark.parametrize("method", ["fit", "transform"])
def test_nothing_or_one_image_alone_is_refused(images, method):
    with pytest.raises(ImageError, match=r"no image to transform|not an array \(4, 4\)"):
        getattr(SFTA(), method)(images)


@pytest.mark.parametrize("method", ["fit", "transform"])
def test_the_faulty_image_is_named(photos, method):
    with pytest.raises(ImageError, match=r"image 1: .*at least one pixel"):
        getattr(SFTA(), method)([photos[0], photos[1, :0]])
