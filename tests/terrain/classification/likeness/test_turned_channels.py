"""Runs of images whose channels are in another order, before a model in colour."""

from dataclasses import replace
from functools import partial

import numpy as np
import pytest

from odometry.recording.run import UNKNOWN
from terrain.classification.answer import TURNED
from terrain.classification.classifier import TerrainClassifier
from terrain.classification.likeness.likeness import FEWEST_IMAGES
from terrain.classification.likeness.turned_channels import (
    ORDERS,
    SMALL,
    TurnedChannels,
    covariances_of,
    orders_of,
)
from terrain.classification.model_file import read_model, write_model
from terrain.image_labels.image_label import ImageLabel
from terrain.image_labels.image_labeller import RunLikeness
from tests.terrain.classification.likeness import coloured_patches
from tests.terrain.classification.likeness.coloured_patches import LIKE, NAMED, SIZE_PX

LIGHTS = ((1.2, 1.0, 0.8), (0.85, 1.0, 1.2), (0.9, 1.1, 0.9), (1.25, 1.0, 0.7))


def sun_and_shade(rng, sigma):
    """Light parts are yellow, dark ones blue."""
    light = rng.normal(0, sigma, (SIZE_PX, SIZE_PX, 1))
    colours = rng.normal(0, sigma / 4, (SIZE_PX, SIZE_PX, 1))
    grain = light * np.array([1.1, 1.0, 0.8]) + colours * np.array([1, 0, -1])
    return grain + rng.normal(0, 1.5, grain.shape)


photographs = partial(coloured_patches.photographs, grain=sun_and_shade)


def in_light(gains):
    return lambda image: np.clip(np.rint(image * np.array(gains)), 0, 255).astype(np.uint8)


def in_order(order):
    return lambda image: np.ascontiguousarray(image[..., list(order)])


@pytest.fixture(scope="module")
def model():
    return TerrainClassifier(colour=True).fit(*photographs(1))


def beyond(model, change):
    return model.likeness([change(image) for image in photographs(2)[0]]).turned_beyond


def test_numbers_by_hand():
    """Red is bright where blue is dark, by half of their mean; green is constant."""
    half = np.arange(48) % 2 * np.ones((48, 1))
    red, blue = np.where(half, 150, 50), np.where(half, 25, 75)
    image = np.dstack([red, np.full((48, 48), 100), blue]).astype(np.uint8)
    covariances = covariances_of(image)
    expected = 0.25 * np.array([[1, 0, -1], [0, 0, 0], [-1, 0, 1]])
    np.testing.assert_allclose(covariances[0], expected, atol=0.01)
    bright, yellow, green = orders_of(covariances)[0, :3]
    assert bright == pytest.approx(np.log(SMALL), abs=0.5)
    assert bright + yellow == pytest.approx(np.log(1.0 + SMALL), abs=0.02)
    assert bright + green == pytest.approx(np.log(SMALL), abs=0.5)


def test_a_light_changes_no_number(rng):
    image = rng.integers(80, 120, (48, 48, 3)).astype(np.uint8)
    shown = in_light((1.6, 1.0, 0.7))(image)
    before, after = (orders_of(covariances_of(of)) for of in (image, shown))
    np.testing.assert_allclose(after, before, atol=0.05)


def test_the_orders_are_those_of_the_image(rng):
    image = rng.integers(0, 250, (30, 40, 3), dtype=np.uint8)
    orders = orders_of(covariances_of(image))
    for order, numbers in zip(ORDERS, orders, strict=True):
        own = orders_of(covariances_of(image[..., list(order)]))[0]
        np.testing.assert_allclose(numbers, own, atol=1e-9)


@pytest.mark.parametrize("order", ORDERS[1:])
def test_another_order_is_noticed(model, order):
    likeness = model.likeness([in_order(order)(image) for image in photographs(2)[0]])
    assert likeness.turned_beyond > 1
    assert "in another order" in likeness.note
    relit = [in_light(LIGHTS[0])(in_order(order)(image)) for image in photographs(2)[0]]
    assert model.likeness(relit).turned_beyond > 1


def test_other_lights_are_not(model):
    assert beyond(model, np.asarray) <= 1
    for gains in LIGHTS:
        assert beyond(model, in_light(gains)) <= 1


def test_a_run_is_judged_as_a_folder_and_few_images_say_nothing(model):
    change = in_order(ORDERS[1])
    run = RunLikeness(model)
    for image in photographs(2)[0]:
        run.add([change(image)])
    assert run.likeness.turned_beyond == pytest.approx(beyond(model, change))
    few = [change(image) for image in photographs(2)[0][: FEWEST_IMAGES - 1]]
    assert model.likeness(few).turned_beyond == 0


def test_no_name_of_turned_images_is_left_where_another_camera_would_pass():
    turned = replace(LIKE, turned_beyond=1.01)
    answer = NAMED.unless_doubtful(turned, 0.5)
    assert (answer.label, answer.reason) == (UNKNOWN, TURNED)
    for probability, label in ((0.71, NAMED.label), (0.69, UNKNOWN)):
        named = replace(NAMED, probability_right=probability)
        assert named.unless_doubtful(turned, 0.95).label == label
    assert not ImageLabel(0.0, "", UNKNOWN, reason=TURNED).is_evidence
    assert NAMED.unless_doubtful(replace(LIKE, turned_beyond=1.0)) == NAMED
    both = replace(LIKE, turned_beyond=1.01, grey_beyond=2.0)
    assert NAMED.unless_doubtful(both).reason == TURNED


def test_a_file_keeps_it_and_older_files_have_none(model, tmp_path):
    model.save(tmp_path / "a.model")
    turned = [in_order(ORDERS[1])(image) for image in photographs(2)[0]]
    assert TerrainClassifier.load(tmp_path / "a.model").likeness(turned) == model.likeness(turned)
    settings, arrays = read_model(tmp_path / "a.model")
    old = {name: array for name, array in arrays.items() if not name.startswith("turned_")}
    write_model(tmp_path / "old.model", settings, old)
    assert TerrainClassifier.load(tmp_path / "old.model").likeness(turned).turned_beyond == 0
    with pytest.raises(ValueError, match="turned channels of shapes"):
        TurnedChannels.from_arrays(arrays | {"turned_limits": np.zeros(3)})
