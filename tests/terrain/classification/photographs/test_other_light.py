"""Models do not learn the light of their photographs."""

import cv2
import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from hypothesis.extra.numpy import arrays

from terrain.classification.classifier import TerrainClassifier
from terrain.classification.photographs import other_light
from terrain.classification.photographs.other_light import (
    MOST_EXPOSURE,
    MOST_GAIN,
    MOST_GAMMA,
    in_another_exposure,
    in_another_white_balance,
    with_other_light,
)
from terrain.classification.photographs.patches import LabelledPatches
from terrain.images import to_grey


@given(arrays(np.uint8, (3, 4, 3)))
def test_red_and_blue_change_by_a_factor_and_green_stays(patch):
    copy = in_another_white_balance(patch)
    np.testing.assert_array_equal(copy, in_another_white_balance(patch))
    np.testing.assert_array_equal(copy[..., 1], patch[..., 1])
    assert np.all(copy <= np.rint(patch * MOST_GAIN))
    assert np.all((copy >= np.rint(patch / MOST_GAIN)) | (copy == 255))
    for channel in (0, 2):
        of = patch[..., channel].ravel().argsort()
        assert np.all(np.diff(copy[..., channel].ravel()[of].astype(int)) >= 0)


@given(arrays(np.uint8, (3, 4)))
def test_grey_levels_keep_their_order(patch):
    copy = in_another_exposure(patch)
    np.testing.assert_array_equal(copy, in_another_exposure(patch))
    assert np.all(np.diff(copy.ravel()[patch.ravel().argsort()].astype(int)) >= 0)


@given(st.integers(0, 255))
def test_one_grey_changes_by_exposure_and_gamma(grey):
    """Contrast says nothing of one grey."""
    copy = in_another_exposure(np.full((2, 2), grey, np.uint8))
    darkest, brightest = (
        255 * MOST_EXPOSURE**sign * (grey / 255) ** MOST_GAMMA**-sign for sign in (-1, 1)
    )
    assert np.rint(darkest) <= copy.min() <= copy.max() <= min(np.rint(brightest), 255)


@pytest.mark.parametrize("colour", [True, False])
def test_every_second_patch_has_a_copy_with_its_terrain_and_photograph(colour):
    patches = [np.full((2, 2, 3), 100, np.uint8)] * 5
    labels, groups = np.array(list("aabbb")), np.arange(5)
    given_copies = LabelledPatches([patches[0]], ["b"], ["9"])
    copies = with_other_light(given_copies, patches, (labels, groups), colour=colour)
    assert copies.labels == ["b", "a", "b", "b"]
    assert copies.groups == ["9", 0, 2, 4]
    assert len(copies.images) == 4
    assert given_copies.labels == ["b"]
    assert copies.images[1].ndim == (3 if colour else 2)


def terrain_photographs(rng, roughness_px, colour, count):
    """Patches (48, 48, 3): noise of that roughness, each photograph in a slightly other light."""
    for _ in range(count):
        noise = cv2.GaussianBlur(rng.normal(size=(48, 48)), (0, 0), roughness_px)
        grey = 1 + 0.25 * noise / noise.std()
        light = np.exp(rng.normal(0, 0.03, 3))
        yield np.clip(np.rint(grey[..., None] * colour * light), 0, 255).astype(np.uint8)


@pytest.fixture(scope="module")
def photographs():
    rng = np.random.default_rng(3)
    terrains = {"clay": (0.9, (130, 110, 90)), "loam": (1.1, (110, 105, 100))}
    return {
        name: list(terrain_photographs(rng, roughness, np.array(colour), 60))
        for name, (roughness, colour) in terrains.items()
    }


def answers_in_cold_light(photographs):
    """Of clay, whose colour is that of loam in a light that is bluer by a fifth."""
    images = photographs["clay"][:40] + photographs["loam"][:40]
    labels = ["clay"] * 40 + ["loam"] * 40
    model = TerrainClassifier("fast", colour=True).fit(images, labels, range(80))
    cold = [
        np.clip(np.rint(image * np.array([0.85, 0.97, 1.1])), 0, 255).astype(np.uint8)
        for image in photographs["clay"][40:]
    ]
    return [max(of.probabilities, key=of.probabilities.get) for of in model.classify(cold)]


def test_a_terrain_keeps_its_name_in_another_light(photographs, monkeypatch):
    assert answers_in_cold_light(photographs).count("clay") >= 18
    monkeypatch.setattr(other_light, "MOST_GAIN", 1.0)
    assert answers_in_cold_light(photographs).count("clay") <= 10


def answers_in_shade(photographs):
    """Of clay in grey, half as bright and with half of the contrast."""
    images = [to_grey(image) for of in photographs.values() for image in of[:40]]
    model = TerrainClassifier("fast").fit(images, ["clay"] * 40 + ["loam"] * 40, range(80))
    dark = [np.asarray(to_grey(image) // 2) for image in photographs["clay"][40:]]
    return [max(of.probabilities, key=of.probabilities.get) for of in model.classify(dark)]


def test_a_terrain_keeps_its_name_under_another_exposure(photographs, monkeypatch):
    assert answers_in_shade(photographs).count("clay") >= 18
    for most in ("MOST_EXPOSURE", "MOST_GAMMA", "MOST_CONTRAST"):
        monkeypatch.setattr(other_light, most, 1.0)
    assert answers_in_shade(photographs).count("clay") <= 12
