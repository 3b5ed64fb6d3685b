"""Runs of images that are nearly grey, before a model in colour."""

from dataclasses import replace
from functools import partial

import numpy as np
import pytest

from odometry.recording.run import UNKNOWN
from terrain.classification.answer import GREYISH, MOST_GREY
from terrain.classification.classifier import TerrainClassifier
from terrain.classification.likeness.chroma import COLOUR_FLOOR, GREEN_FLOOR, chroma_of
from terrain.classification.likeness.likeness import FEWEST_IMAGES
from terrain.classification.likeness.nearly_grey import CHANGES, NearlyGrey, made_grey
from terrain.classification.model_file import read_model, write_model
from terrain.image_labels.image_label import ImageLabel
from terrain.image_labels.image_labeller import RunLikeness
from terrain.images import to_grey
from tests.terrain.classification.likeness import coloured_patches
from tests.terrain.classification.likeness.coloured_patches import LIKE, NAMED, SIZE_PX


def grains(rng, sigma):
    """Of colours of their own."""
    grey = rng.normal(0, sigma, (SIZE_PX, SIZE_PX, 1))
    return grey + rng.normal(0, sigma / 3, (SIZE_PX, SIZE_PX, 3))


photographs = partial(coloured_patches.photographs, grain=grains)


def warm_grey(image):
    return np.rint(to_grey(image)[..., None] * np.array([1.0, 0.95, 0.9])).astype(np.uint8)


@pytest.fixture(scope="module")
def model():
    return TerrainClassifier(colour=True).fit(*photographs(1))


def test_colour_beyond_a_line_through_green_by_hand():
    """Red follows green and leaves it by 4 greys, blue is constant."""
    green = np.repeat([[50, 90], [90, 50]], 24, axis=0).repeat(24, axis=1)
    off = np.where(np.arange(48) % 2, 4, -4)[:, None] * np.ones(48)
    image = np.dstack([green + off, green, np.full((48, 48), 70)]).astype(np.uint8)
    expected = np.log([4 + COLOUR_FLOOR, COLOUR_FLOOR, 20 + GREEN_FLOOR])
    np.testing.assert_allclose(chroma_of(image)[:3], expected, atol=1e-3)
    of_squares = np.log([COLOUR_FLOOR, COLOUR_FLOOR, 20 + GREEN_FLOOR])  # their means do not leave
    np.testing.assert_allclose(chroma_of(image)[3:6], of_squares, atol=0.02)


def test_a_tint_is_no_colour_and_a_full_channel_says_nothing(rng):
    grey = rng.integers(40, 120, (48, 48, 1)) * np.array([2.0, 1.0, 0.5])
    assert chroma_of(grey.astype(np.uint8))[0] < np.log(0.5)
    grey[:24] *= 2.0  # red would be above 255
    full = np.clip(grey, 0, 255).astype(np.uint8)
    assert chroma_of(full)[0] < np.log(0.5)
    assert np.isfinite(chroma_of(np.full((48, 48, 3), 255, np.uint8))).all()


def test_nearly_grey_photographs_are_noted_and_others_are_not(model):
    held_out = photographs(2)[0]
    own, changed = (model.likeness([f(i) for i in held_out]) for f in (np.asarray, warm_grey))
    assert own.grey_beyond < 1 < changed.grey_beyond
    assert "grey" not in (own.note or "")
    assert "images are nearly grey" in changed.note
    assert "exchanged" not in replace(changed, exchanged=True).note
    run = RunLikeness(model)
    for image in held_out:
        run.add([warm_grey(image)])
    assert run.likeness.grey_beyond == pytest.approx(changed.grey_beyond)
    few = [warm_grey(image) for image in held_out[: FEWEST_IMAGES - 1]]
    assert model.likeness(few).grey_beyond == 0


def test_copies_are_tinted_or_lose_colour():
    patch = np.full((SIZE_PX, SIZE_PX, 3), (180, 120, 100), np.uint8)
    means = np.array([made_grey(patch, change).mean(axis=(0, 1)) for change in range(CHANGES)])
    grey = 0.3 * 180 + 0.59 * 120 + 0.11 * 100
    np.testing.assert_allclose(means[0], grey * np.array([1.0, 0.98, 0.93]), atol=1.5)
    np.testing.assert_allclose(means[3], grey + 0.1 * (patch[0, 0] - grey), atol=1.5)


def test_no_name_of_nearly_grey_images_is_left():
    answer = NAMED.unless_doubtful(replace(LIKE, grey_beyond=MOST_GREY + 0.01))
    assert (answer.label, answer.reason) == (UNKNOWN, GREYISH)
    assert not ImageLabel(0.0, "", UNKNOWN, reason=GREYISH).is_evidence
    assert NAMED.unless_doubtful(replace(LIKE, grey_beyond=MOST_GREY)) == NAMED


def test_a_file_keeps_it_and_older_files_have_none(model, tmp_path):
    model.save(tmp_path / "a.model")
    changed = [warm_grey(image) for image in photographs(2)[0]]
    assert TerrainClassifier.load(tmp_path / "a.model").likeness(changed) == model.likeness(changed)
    settings, arrays = read_model(tmp_path / "a.model")
    old = {name: array for name, array in arrays.items() if not name.startswith("grey_")}
    write_model(tmp_path / "old.model", settings, old)
    assert TerrainClassifier.load(tmp_path / "old.model").likeness(changed).grey_beyond == 0
    with pytest.raises(ValueError, match="nearly grey images of shapes"):
        NearlyGrey.from_arrays(arrays | {"grey_weights": np.zeros(3)})
