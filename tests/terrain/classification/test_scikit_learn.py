"""The terrain classifier in the hands of scikit-learn."""

import numpy as np
import pytest
import sklearn
from PIL import Image
from sklearn.base import clone
from sklearn.exceptions import NotFittedError
from sklearn.model_selection import GridSearchCV, GroupKFold, cross_val_score
from sklearn.pipeline import make_pipeline

from terrain.classification import classifier
from terrain.classification.classifier import TerrainClassifier
from terrain.classification.sfta_features import SftaFeatures
from terrain.errors import ImageError, ModelFileError

NEW = np.random.default_rng(7)


@pytest.fixture(scope="module")
def whole(training_patches):
    """Images, labels and groups, every second photograph."""
    images, labels, groups = training_patches
    kept = [k for k, group in enumerate(groups) if int(group.split()[1]) % 2 == 0]
    return [[one[k] for k in kept] for one in (images, labels, groups)]


def test_predictions_are_the_answers_without_unknown(whole, classifier):
    images, labels = [*whole[0], np.full((32, 32), 90, np.uint8)], [*whole[1], "gravel"]
    answers = classifier.classify(images)
    probabilities = classifier.predict_proba(images)
    given = np.array([list(answer.probabilities.values()) for answer in answers])  # calibrated
    np.testing.assert_array_equal(probabilities.argmax(axis=1), given.argmax(axis=1))
    names = classifier.classes_[probabilities.argmax(axis=1)]
    assert classifier.predict(images).tolist() == names.tolist()
    unknown = [answer.label == "unknown" for answer in answers]
    assert classifier.is_unknown(images).tolist() == unknown
    assert 0 < sum(unknown) < len(images)
    assert classifier.score(images, labels) == np.mean(names == np.array(labels)) > 0.9


def test_an_array_of_images_is_as_good_as_a_list_and_a_larger_one_is_cut(whole, classifier):
    images = whole[0][:4]
    stacked = classifier.predict_proba(np.stack(images))
    np.testing.assert_array_equal(stacked, classifier.predict_proba(images))
    wide = np.hstack(images[:2])
    np.testing.assert_allclose(
        classifier.predict_proba([wide, images[2]]), [stacked[:2].mean(axis=0), stacked[2]]
    )


def test_images_of_pillow_are_arrays_and_what_is_no_image_is_said(whole, classifier):
    arrays = [np.ascontiguousarray(image) for image in whole[0][:4]]
    pillows = [Image.fromarray(image) for image in arrays]
    assert classifier.predict(pillows).tolist() == classifier.predict(arrays).tolist()
    coloured = [Image.fromarray(np.stack([image] * 3, axis=-1)).convert("P") for image in arrays]
    assert classifier.classify(coloured)[0].label
    for none in ([], np.empty((0, 40, 40), np.uint8)):
        with pytest.raises(ImageError, match="no images to name"):
            classifier.predict(none)
    with pytest.raises(ImageError, match=r"image 1 is str .*read_image reads a file"):
        classifier.classify([arrays[0], "1.png"])


def test_without_groups_each_patch_is_of_its_own(whole):
    images, labels, _ = whole
    alone = range(len(images))
    models = [
        TerrainClassifier("chen2023").fit(images, labels, *groups) for groups in ((), (alone,))
    ]
    assert models[0].rejection_distance_ == models[1].rejection_distance_
    assert models[0].n_neighbors_ == models[1].n_neighbors_


@pytest.mark.parametrize("preset", ["default", "fast", "chen2023"])
def test_features_made_before_give_what_images_give(whole, preset, monkeypatch):
    """But for copies in another light, which are made of images."""
    monkeypatch.setattr(classifier, "with_other_light", lambda copies, *_, **__: copies)
    images, labels, groups = whole
    of_images = TerrainClassifier(preset).fit(images, labels, groups)
    pipeline = make_pipeline(SftaFeatures(preset), TerrainClassifier(preset))
    pipeline.fit(images, labels, terrainclassifier__groups=groups)
    np.testing.assert_array_equal(pipeline.predict_proba(images), of_images.predict_proba(images))
    assert pipeline[-1].n_features_in_ == of_images.n_features_in_
    assert pipeline[-1].n_features_in_ == len(pipeline[0].get_feature_names_out())
    assert pipeline[-1].rejection_distance_ == of_images.rejection_distance_


def test_images_of_different_sizes_are_classified_by_their_features(whole):
    images, labels, _ = whole
    sizes = NEW.integers(26, 33, len(images))
    cut = [image[:size, 32 - size :] for image, size in zip(images, sizes, strict=True)]
    pipeline = make_pipeline(SftaFeatures(), TerrainClassifier()).fit(cut, labels)
    assert pipeline.score(images, labels) > 0.9


def test_cross_validation_keeps_groups_whole(whole):
    images, labels, groups = whole
    scores = cross_val_score(
        TerrainClassifier("chen2023"), images, labels, groups=groups, cv=GroupKFold(3)
    )
    assert len(scores) == 3
    assert scores.min() > 0.7


def test_a_search_over_a_grid_hands_groups_to_the_fit(whole):
    images, labels, groups = whole
    seen = []

    class Listening(TerrainClassifier):
        def fit(self, X, y, groups=None):
            seen.append(None if groups is None else set(groups))
            return super().fit(X, y, groups)

    with sklearn.config_context(enable_metadata_routing=True):
        model = Listening("chen2023").set_fit_request(groups=True)
        search = GridSearchCV(model, {"n_neighbors": [1, 5]}, cv=GroupKFold(3))
        search.fit(images, labels, groups=groups)
    assert search.best_params_["n_neighbors"] in {1, 5}
    assert search.best_estimator_.n_neighbors_ == search.best_params_["n_neighbors"]
    assert None not in seen
    assert [len(of) for of in seen] == [8, 8, 8, 8, 8, 8, 12]


def test_a_clone_has_the_parameters_and_nothing_learned(classifier, whole):
    copy = clone(classifier.set_params(rejected_share=0.05))
    assert copy.get_params() == classifier.get_params()
    assert set(copy.get_params()) == {
        "preset",
        "colour",
        "metres_per_pixel",
        "rejected_share",
        "n_neighbors",
        "features",
    }
    with pytest.raises(NotFittedError):
        copy.predict(whole[0])


def test_a_model_of_features_looks_at_no_image(whole, tmp_path):
    images, labels, _ = whole
    features = SftaFeatures("chen2023").transform(images)
    model = TerrainClassifier("chen2023").fit(features, labels)
    with pytest.raises(ImageError, match="fitted on features"):
        model.classify(images)
    with pytest.raises(ModelFileError, match="fitted on features"):
        model.save(tmp_path / "terrain.model")


def test_names_of_features_tell_copy_and_binary_image_and_come_before_those_of_statistics():
    names = SftaFeatures("default", colour=True).get_feature_names_out()
    assert len(set(names)) == len(names) == 21 * 24 + 377 + 46
    assert names[0] == "grey_D1"
    assert names[21 * 24 - 1] == "yellow_blue_G8"
    assert names[21 * 24] == "joint_grey_grey"
    assert names[-1] == "gabor_third_14"
