"""The distance of an image: its patches are evaluated together."""

import numpy as np
import pytest

from terrain.classification.classifier import TerrainClassifier
from terrain.classification.held_out import rejection_roc_area
from terrain.classification.model_file import read_model, write_model
from terrain.classification.neighbours.neighbours import DiscriminantNeighbours
from terrain.classification.neighbours.rejection import PATCHES, images_of_patches, quantiles
from terrain.classification.neighbours.validation import Samples, cross_validate
from terrain.classification.presets import PlainNeighbours, linear_neighbours
from terrain.errors import ModelFileError

CLASSES, FEATURES, EACH = 3, 8, 8


def drawn(rng, middles, images):
    """Features and codes of images of eight patches about the middles of terrains."""
    codes = np.repeat(np.arange(len(middles)), images * EACH)
    return middles[codes] + rng.normal(size=(len(codes), FEATURES)), codes


def whole(count):
    return list(np.arange(count).reshape(-1, EACH))


@pytest.fixture
def middles():
    return 2.0 * np.eye(FEATURES)[:CLASSES]


@pytest.fixture
def samples(rng, middles):
    return drawn(rng, middles, 12)


@pytest.mark.parametrize("kind", [PlainNeighbours, DiscriminantNeighbours])
def test_an_image_of_one_patch_has_the_distance_of_the_patch(kind, samples, rng):
    model, queries = kind().fit(*samples), rng.normal(size=(20, FEATURES))
    labels, distances = model.labels_and_image_distances(queries, 3, np.arange(20)[:, None])
    np.testing.assert_allclose(distances, model.distances(queries), rtol=1e-9)
    np.testing.assert_array_equal(labels, model.labels(queries, 3))


def test_an_image_is_as_far_as_the_mean_place_of_its_patches(samples, rng):
    """The same place among the discriminants and as familiar a look: the distance of one patch."""
    model = DiscriminantNeighbours().fit(*samples)
    patch = rng.normal(size=(1, FEATURES))
    _, same = model.labels_and_image_distances(np.repeat(patch, 4, axis=0), 1, [np.arange(4)])
    assert same[0] == pytest.approx(model.distances(patch)[0], rel=1e-9)
    queries = rng.normal(size=(8, FEATURES))
    places = model.discriminants(queries)
    points, means = model.samples()[0], model.class_means_
    middle = places.mean(axis=0)
    to_points = np.sort(np.linalg.norm(points - middle, axis=1))[:5].mean()
    expected = np.log(to_points * np.linalg.norm(means - middle, axis=1).min())
    for place, distance in zip(places, model.distances(queries), strict=True):
        alone = np.sort(np.linalg.norm(points - place, axis=1))[:5].mean()
        factors = alone * np.linalg.norm(means - place, axis=1).min()
        expected += np.log(distance / factors) / 8
    _, found = model.labels_and_image_distances(queries, 1, [np.arange(8)])
    assert np.log(found[0]) == pytest.approx(expected, abs=1e-6)


def test_together_patches_detect_a_terrain_between_two_better_than_their_median(
    samples, middles, rng
):
    """Gaussian terrains, and one between two of them: noise of patches hides where it lies."""
    model = DiscriminantNeighbours(cosines=0).fit(*samples)
    known, _ = drawn(rng, middles, 20)
    between, _ = drawn(rng, middles[:2].mean(axis=0, keepdims=True), 60)
    together = [
        model.labels_and_image_distances(of, 1, whole(len(of)))[1] for of in (known, between)
    ]
    medians = [np.median(model.distances(of).reshape(-1, EACH), axis=1) for of in (known, between)]
    assert rejection_roc_area(*together) > rejection_roc_area(*medians) + 0.1


def test_parts_of_photographs_stand_for_images():
    groups = np.repeat(["a", "b"], [8, 3])
    rows = [of.tolist() for of in images_of_patches(groups, 4)]
    assert rows == [[0, 2, 4, 6], [1, 3, 5, 7], [8, 9, 10]]
    assert len(images_of_patches(groups, 1)) == 11


def test_limits_leave_the_share_requested_of_held_out_images_beyond(rng, middles):
    features, codes = drawn(rng, middles, 60)
    groups = np.arange(len(codes)) // EACH
    found = cross_validate(linear_neighbours, (9,), Samples(features, codes, groups))
    np.testing.assert_allclose(np.sort(found.image_distances[0]), np.sort(found.distances))
    limits = quantiles(found.image_distances, 0.1)
    model = linear_neighbours().fit(features, codes)
    fresh, _ = drawn(rng, middles, 200)
    for count in (1, 8):
        parts = list(np.arange(len(fresh)).reshape(-1, count))
        _, distances = model.labels_and_image_distances(fresh, 1, parts)
        limit = limits[PATCHES.index(count)]
        assert np.mean(distances > limit) == pytest.approx(0.1, abs=0.05)


def textures(rng):
    """Grains of two sizes, 32 px."""
    fine = rng.integers(0, 256, (32, 32), dtype=np.uint8)
    coarse = np.kron(rng.integers(0, 256, (8, 8), dtype=np.uint8), np.ones((4, 4), np.uint8))
    return [fine, coarse]


def test_files_of_version_0_12_judge_the_median(tmp_path, rng):
    images = [image for _ in range(12) for image in textures(rng)]
    names, photos = ["fine", "coarse"] * 12, [str(i // 4) for i in range(24)]
    classifier = TerrainClassifier().fit(images, names, photos)
    classifier.save(tmp_path / "new.model")
    settings, arrays = read_model(tmp_path / "new.model")
    again = TerrainClassifier.load(tmp_path / "new.model")
    assert again.image_rejection_distances_ == classifier.image_rejection_distances_
    larger = np.hstack(textures(rng))
    assert again.classify([larger]) == classifier.classify([larger])

    write_model(
        tmp_path / "bad.model", settings, {k: a for k, a in arrays.items() if k != "class_means"}
    )
    with pytest.raises(ModelFileError, match="class means"):
        TerrainClassifier.load(tmp_path / "bad.model")

    del settings["image_rejection_distances"]
    write_model(tmp_path / "old.model", settings, arrays)
    old = TerrainClassifier.load(tmp_path / "old.model")
    assert old.image_rejection_distances_ is None
    halves = old.classify([larger[:, :32], larger[:, 32:]])
    median, limits = np.median([half.distance for half in halves]), old.rejection_distances_
    (answer,) = old.classify([larger])
    assert answer.distance == pytest.approx(median * limits[0] / limits[1])
