from collections import Counter

import numpy as np
import pytest
from sklearn.neighbors import KNeighborsClassifier

from odometry.errors import ConfigError
from terrain.classification.classifier import TerrainClassifier
from terrain.classification.features.features import patch_features
from terrain.classification.model_file import read_model, write_model
from terrain.classification.presets import PRESETS
from terrain.classification.sfta_features import SftaFeatures
from terrain.errors import ImageError, ModelFileError, PatchError
from terrain.images import to_grey
from terrain.texture import sfta

SIZE = 32


def grains(rng, size=SIZE):
    return rng.normal(120, 40, (size, size)).clip(0, 255).astype(np.uint8)


def stripes(rng, size=SIZE):
    phase, angle = rng.uniform(0, 2 * np.pi), rng.uniform(0, np.pi)
    rows, columns = np.mgrid[:size, :size]
    wave = np.sin((np.cos(angle) * rows + np.sin(angle) * columns) / 2 + phase)
    return (120 + 40 * wave + rng.normal(0, 4, (size, size))).clip(0, 255).astype(np.uint8)


def blobs(rng, size=SIZE):
    return np.kron(grains(rng, size // 8), np.ones((8, 8), np.uint8))


def features_of(image):
    return patch_features([image], PRESETS["default"].features)


def patches(rng, textures, photos=6, each=2):
    images, labels, groups = [], [], []
    for texture in textures:
        for photo in range(photos):
            images += [texture(rng) for _ in range(each)]
            labels += [texture.__name__] * each
            groups += [f"{texture.__name__} {photo}"] * each
    return images, labels, groups


@pytest.fixture(scope="module", params=["default", "chen2023"])
def trained(request):
    training = patches(np.random.default_rng(1), (grains, stripes))
    return TerrainClassifier(request.param, metres_per_pixel=0.01).fit(*training)


def test_fresh_patches_get_their_names(trained, rng):
    answers = trained.classify([texture(rng) for texture in (grains, stripes) for _ in range(20)])
    named = Counter(
        zip(["grains"] * 20 + ["stripes"] * 20, (a.label for a in answers), strict=True)
    )
    assert named["grains", "grains"] + named["stripes", "stripes"] >= 34
    assert named["grains", "stripes"] + named["stripes", "grains"] <= 1
    for answer in answers:
        assert sum(answer.probabilities.values()) == pytest.approx(1)
        assert answer.confidence == max(answer.probabilities.values())
        beyond = answer.distance > trained.rejection_distance_
        assert (answer.label == "unknown") == beyond


def test_unlike_terrain_is_unknown(rng):
    model = TerrainClassifier().fit(*patches(rng, (grains, stripes)))
    strange = [blobs(rng) for _ in range(10)] + [np.full((SIZE, SIZE), 90, np.uint8)]
    answers = model.classify(strange)
    assert [a.label for a in answers] == ["unknown"] * 11
    assert min(a.distance for a in answers) > 3 * model.rejection_distance_


def test_chen2023_is_scikit_learns_knn_on_plain_sfta(rng):
    images, labels, groups = patches(rng, (grains, stripes, blobs))
    model = TerrainClassifier("chen2023").fit(images, labels, groups)
    fresh = [texture(rng) for texture in (grains, stripes, blobs) for _ in range(5)]
    knn = KNeighborsClassifier(model.n_neighbors_).fit([sfta(i) for i in images], labels)
    expected = knn.predict_proba([sfta(i) for i in fresh])
    answers = [list(a.probabilities.values()) for a in model.classify(fresh)]
    np.testing.assert_allclose(answers, expected)


def test_a_large_image_is_the_vote_of_its_patches(trained, rng):
    image = np.block([[grains(rng), stripes(rng)], [stripes(rng), stripes(rng)]])
    parts = [image[r : r + SIZE, c : c + SIZE] for r in (0, SIZE) for c in (0, SIZE)]
    whole, *pieces = trained.predict_proba([np.pad(image, ((3, 4), (5, 5))), *parts])
    np.testing.assert_allclose(whole, np.mean(pieces, axis=0))


def test_too_small_an_image_is_an_error(trained):
    with pytest.raises(ImageError, match=r"40 x 31 pixels is smaller.* 32 x 32"):
        trained.classify([np.zeros((31, 40), np.uint8)])


def test_a_loaded_classifier_gives_the_same_answers_and_bytes(trained, rng, tmp_path):
    trained.save(str(tmp_path / "a.model"))
    loaded = TerrainClassifier.load(str(tmp_path / "a.model"))
    fresh = [texture(rng) for texture in (grains, stripes, blobs)]
    assert loaded.classify(fresh) == trained.classify(fresh)
    assert loaded.classes_.tolist() == trained.classes_.tolist()
    for name in ("preset", "patch_size_px", "metres_per_pixel", "colour_", "n_features_in_"):
        assert getattr(loaded, name) == getattr(trained, name)
    loaded.save(tmp_path / "b.model")
    assert (tmp_path / "b.model").read_bytes() == (tmp_path / "a.model").read_bytes()


def test_training_twice_gives_the_same_bytes(tmp_path):
    for name in ("a", "b"):
        training = patches(np.random.default_rng(5), (grains, blobs))
        TerrainClassifier().fit(*training).save(tmp_path / name)
    assert (tmp_path / "a").read_bytes() == (tmp_path / "b").read_bytes()


@pytest.mark.parametrize(
    "change",
    [
        {"preset": "other"},
        {"classes": ["grains"]},
        {"n_neighbors": "3"},
        {"n_neighbors": 10**6},
        {"patch_size_px": None},
        {"rejection_distance": "far"},
        {"features": {"grey_copies": ["wavelets"], "colour_copies": []}},
        {"features": {"grey_copies": ["grey"] * 3, "colour_copies": [], "n_thresholds": 2,
                      "counts_per_area": True}},
    ],
)  # fmt: skip
def test_settings_that_do_not_fit_are_refused(trained, change, tmp_path):
    trained.save(tmp_path / "a.model")
    settings, arrays = read_model(tmp_path / "a.model")
    write_model(tmp_path / "b.model", settings | change, arrays)
    with pytest.raises(ModelFileError, match=r"b\.model"):
        TerrainClassifier.load(tmp_path / "b.model")


@pytest.mark.parametrize("lost", ["points", "codes"])
def test_arrays_that_do_not_fit_are_refused(trained, lost, tmp_path):
    trained.save(tmp_path / "a.model")
    settings, arrays = read_model(tmp_path / "a.model")
    for changed in ({}, {lost: arrays[lost][:-1]}):
        kept = {name: array for name, array in arrays.items() if name != lost}
        write_model(tmp_path / "b.model", settings, kept | changed)
        with pytest.raises(ModelFileError, match=r"b\.model"):
            TerrainClassifier.load(tmp_path / "b.model")


def test_the_rejection_distance_leaves_its_share_of_known_terrain_beyond(rng):
    model = TerrainClassifier(rejected_share=0.25).fit(*patches(rng, (grains, stripes), 10))
    beyond = np.mean(model.cross_validation_.distances > model.rejection_distance_)
    assert beyond == pytest.approx(0.25, abs=0.02)
    assert model.cross_validation_.codes.tolist() == [0] * 20 + [1] * 20


def test_two_photographs_a_class_suffice_and_one_does_not(rng):
    images, labels, groups = patches(rng, (grains, stripes), photos=2, each=2)
    assert TerrainClassifier().fit(images, labels, groups).n_neighbors_ == 1
    with pytest.raises(PatchError, match=r"grains 2, stripes 1\. Add photographs of stripes$"):
        TerrainClassifier().fit(images[:-2], labels[:-2], groups[:-2])
    with pytest.raises(PatchError, match=r"photographs found: grains 2$"):
        TerrainClassifier().fit(images[:4], labels[:4], groups[:4])
    with pytest.raises(PatchError, match="photographs found: none"):
        TerrainClassifier().fit([], [], [])


def test_patches_that_cannot_be_used_are_errors(rng):
    images, labels, groups = patches(rng, (grains, stripes), photos=2, each=1)
    with pytest.raises(PatchError, match=r"one size; found: \[\(16, 32\), \(32, 32\)\]"):
        TerrainClassifier().fit([images[0][:16], *images[1:]], labels, groups)
    with pytest.raises(PatchError, match=r"one size; found: \[\(16, 16\), \(32, 32\)\]"):
        TerrainClassifier().fit([images[0][:16, :16], *images[1:]], labels, groups)
    with pytest.raises(PatchError, match="4 images, 3 labels and 4 groups"):
        TerrainClassifier().fit(images, labels[1:], groups)
    for name in ("unknown", "unknown 1"):
        with pytest.raises(PatchError, match=f"'{name}' is reserved"):
            TerrainClassifier().fit(images, [name, *labels[1:]], groups)


def test_without_variety_within_classes_nothing_can_be_learned(rng):
    images, labels, groups = patches(rng, (grains, stripes), photos=2, each=1)
    features = SftaFeatures().fit_transform(images)  # images themselves vary in their copies
    with pytest.raises(PatchError, match="4 patches of 2 classes are too few, or too much alike"):
        TerrainClassifier().fit(features, labels, groups)


def test_one_class_of_equal_patches_is_learned(rng):
    images, labels, groups = patches(rng, (grains, stripes))
    images[:12] = [images[0]] * 12
    assert TerrainClassifier().fit(images, labels, groups).classify(images[:1])[0].label == "grains"


@pytest.mark.parametrize(
    ("settings", "message"),
    [
        ({"preset": "best"}, "'best' is not one of chen2023, default"),
        ({"rejected_share": 1}, "rejected_share is 1"),
        ({"metres_per_pixel": 0.0}, r"metres_per_pixel is 0\.0"),
        ({"n_neighbors": 0}, "n_neighbors is 0"),
    ],
)
def test_settings_outside_their_range_are_errors_of_fit(rng, settings, message):
    with pytest.raises(ConfigError, match=message):
        TerrainClassifier(**settings).fit(*patches(rng, (grains, stripes)))


def reddish(rng):
    return np.stack([grains(rng)] * 3, axis=2) // 2 + np.array([60, 0, 0], np.uint8)


def bluish(rng):
    return np.stack([grains(rng)] * 3, axis=2) // 2 + np.array([0, 0, 60], np.uint8)


@pytest.mark.slow
def test_colour_is_used_only_when_requested_and_there(rng, tmp_path):
    training = patches(rng, (reddish, bluish), photos=5)
    fresh = [bluish(rng) for _ in range(10)] + [reddish(rng) for _ in range(10)]
    names = ["bluish"] * 10 + ["reddish"] * 10
    coloured = TerrainClassifier(colour=True).fit(*training)
    assert coloured.colour_
    best = [max(a.probabilities, key=a.probabilities.get) for a in coloured.classify(fresh)]
    assert best == names
    coloured.save(tmp_path / "a.model")
    assert TerrainClassifier.load(tmp_path / "a.model").classify(fresh) == coloured.classify(fresh)
    with pytest.raises(ImageError, match="grey"):
        coloured.classify([grains(rng)])
    grey = TerrainClassifier().fit(*training)
    assert not grey.colour_
    without_colour = [to_grey(image) for image in fresh]
    assert grey.classify(fresh) == grey.classify(without_colour)


def test_colour_stays_off_for_grey_patches_and_for_the_paper(rng):
    images, labels, groups = patches(rng, (reddish, bluish), photos=2)
    assert not TerrainClassifier("chen2023", colour=True).fit(images, labels, groups).colour_
    images[3] = np.repeat(images[3][..., :1], 3, axis=2)
    assert TerrainClassifier(colour=True).fit(images, labels, groups).colour_
    for i in np.flatnonzero(np.array(labels) == labels[0]):
        images[i] = np.repeat(images[i][..., :1], 3, axis=2)
    model = TerrainClassifier(colour=True).fit(images, labels, groups)
    assert not model.colour_
    assert model.classify([grains(rng)])
