"""Whether the colours of images are those of the training photographs."""

from dataclasses import replace

import numpy as np
import pytest

from odometry.recording.run import UNKNOWN
from terrain.classification.answer import COLOURLESS
from terrain.classification.classifier import TerrainClassifier
from terrain.classification.likeness.colour_range import (
    EXCHANGED_LEAST,
    ColourRange,
    colours_of,
    is_colourless,
)
from terrain.classification.likeness.likeness import FEWEST_IMAGES, Likeness
from terrain.classification.own_statistics import OwnStatisticsClassifier
from terrain.image_labels.image_label import ImageLabel
from terrain.image_labels.image_labeller import RunLikeness

SIZE_PX = 48
BROWN, GREEN = (150, 110, 70), (90, 120, 60)


def photographs(seed, photos=8, each=3):
    """Patches of brown and of green terrain; photographs of each differ in colour."""
    rng = np.random.default_rng(seed)
    images, labels, groups = [], [], []
    for label, colour in (("brown", BROWN), ("green", GREEN)):
        for photo in range(photos):
            mean = np.array(colour) * rng.uniform(0.9, 1.1, 3)
            for _ in range(each):
                image = (
                    mean + rng.normal(0, 15, (SIZE_PX, SIZE_PX, 1)) + rng.normal(0, 3, (1, 1, 3))
                )
                images.append(np.clip(image, 0, 255).astype(np.uint8))
                labels.append(label)
                groups.append(f"{label} {photo}")
    return images, np.array(labels), np.array(groups)


@pytest.fixture(scope="module")
def model():
    return TerrainClassifier(colour=True).fit(*photographs(1))


def likeness_of(model, change):
    return model.likeness([change(image) for image in photographs(2)[0]])


def as_they_are(image):
    return image


def exchanged(image):
    return image[..., ::-1]


def greener(image):
    return np.clip(image * np.array([0.8, 1.0, 0.8]), 0, 255).astype(np.uint8)


def colourless(image):
    return np.repeat(image[..., :1], 3, axis=2)


def test_colours_by_hand():
    image = np.broadcast_to(np.array([51, 102, 204], np.uint8), (4, 5, 3))
    expected = [np.log(0.21) - np.log(0.41), np.log(0.81) - np.log(0.41)]
    np.testing.assert_allclose(colours_of(image), expected, rtol=1e-12)
    assert np.isfinite(colours_of(np.zeros((2, 2, 3), np.uint8))).all()


def test_distances_and_limit_by_hand():
    """Of photographs of one patch each: every run holds all three of its terrain."""
    greens = (100, 110, 130, 60, 64, 90)
    patches = [np.full((4, 4, 3), (120, green, 80), np.uint8) for green in greens]
    of = ColourRange.of(patches, np.repeat([0, 1], 3), np.arange(6))
    colours = np.array([colours_of(patch) for patch in patches])
    apart = np.linalg.norm(colours[:, None] - colours, axis=2) + np.diag([np.inf] * 6)
    means = apart.min(axis=1).reshape(2, 3).mean(axis=1)
    assert of.limit == pytest.approx(means.max(), rel=1e-9)
    there = np.array([[0.3, 0.1]])
    nearest = [np.linalg.norm(colours - of, axis=1).min() for of in (there, there[:, ::-1])]
    np.testing.assert_allclose(of.distances(there), [nearest], rtol=1e-12)


def test_photographs_held_out_are_like_training(model):
    likeness = likeness_of(model, as_they_are)
    assert likeness.colour_beyond <= 1
    assert not likeness.exchanged
    assert "colour" not in (likeness.note or "")


def test_red_and_blue_exchanged(model):
    likeness = likeness_of(model, exchanged)
    assert likeness.colour_beyond > 1
    assert likeness.exchanged
    assert "in another order" in likeness.note
    assert "either blue comes first" in replace(likeness, turned_beyond=0.0).note


def test_another_white_balance_is_no_exchange(model):
    likeness = likeness_of(model, greener)
    assert likeness.colour_beyond > 1
    assert not likeness.exchanged
    assert "colours of the images are unlike" in likeness.note


def test_both_notes_are_sentences():
    one = Likeness(FEWEST_IMAGES, 0.9, 0.9, (), beyond=2.0, colour_beyond=2.0)
    assert "train with them. The colours of the images are unlike" in one.note


def test_grey_images_have_no_colours_to_compare(model):
    assert model.likeness([image[..., 0] for image in photographs(2)[0]]).colour_beyond == 0


def test_own_statistics_compare_colours_as_well(model):
    run = RunLikeness(OwnStatisticsClassifier(model))
    for image in photographs(2)[0]:
        run.add([exchanged(image)])
    assert run.likeness.exchanged


def test_few_images_say_nothing(model):
    few = [exchanged(image) for image in photographs(2)[0][: FEWEST_IMAGES - 1]]
    assert model.likeness(few).colour_beyond == 0


def test_a_small_difference_is_no_exchange():
    """Grey terrain is as near with both orders, by a factor that means nothing."""
    near = np.tile([2.2 * EXCHANGED_LEAST / 3, 0.001, *np.zeros(6)], (FEWEST_IMAGES, 1))
    of = ColourRange(np.zeros((1, 2)), 1.0)
    one = Likeness(FEWEST_IMAGES, 0.5, 0.5, ())
    assert not of.compared(one, near).exchanged
    assert of.compared(one, 3 * near).exchanged


def test_a_run_is_compared_as_a_folder(model):
    run = RunLikeness(model)
    for image in photographs(2)[0]:
        run.add([exchanged(image)])
    folder = likeness_of(model, exchanged)
    assert run.likeness.colour_beyond == pytest.approx(folder.colour_beyond)
    assert run.likeness.exchanged


def test_a_grey_image_in_three_channels_has_no_name(model):
    images = photographs(2)[0][:4]
    for answer in model.classify([colourless(image) for image in images]):
        assert (answer.label, answer.reason) == (UNKNOWN, COLOURLESS)
        assert not ImageLabel(0.0, "", answer.label, reason=answer.reason).is_evidence
    assert not any(answer.reason == COLOURLESS for answer in model.classify(images))


@pytest.mark.parametrize(("grey_in", "is_known"), [(("brown",), False), (("brown", "green"), True)])
def test_grey_images_have_names_where_every_terrain_was_grey_in_training(grey_in, is_known):
    images, labels, groups = photographs(1)
    for i, (label, group) in enumerate(zip(labels, groups, strict=True)):
        if label in grey_in and int(group.split()[1]) < 3:
            images[i] = colourless(images[i])
    model = TerrainClassifier(colour=True).fit(images, labels, groups)
    assert model.colour_
    answers = model.classify([colourless(image) for image in photographs(2)[0]])
    assert all((answer.reason == COLOURLESS) != is_known for answer in answers)


def test_compression_hardly_colours_a_grey_image(rng):
    image = np.repeat(rng.integers(0, 255, (8, 8, 1), dtype=np.uint8), 3, axis=2)
    assert is_colourless(image)
    image[3, 3, 0] ^= 1
    assert is_colourless(image)
    image[3, 3] = 120, 120, 123
    assert not is_colourless(image)


def test_a_file_keeps_the_colours(model, tmp_path):
    model.save(tmp_path / "a.model")
    loaded = TerrainClassifier.load(tmp_path / "a.model")
    assert likeness_of(loaded, exchanged) == likeness_of(model, exchanged)
    assert ColourRange.from_arrays({}) is None
    with pytest.raises(ValueError, match="shapes"):
        ColourRange.from_arrays({"colour_points": np.zeros((3, 3)), "colour_numbers": np.ones(2)})


def test_a_grey_model_says_nothing_of_colours():
    model = TerrainClassifier().fit(*photographs(1))
    assert model.colour_range_ is None
    assert likeness_of(model, exchanged).colour_beyond == 0
