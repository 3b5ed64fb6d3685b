from copy import copy

import cv2
import numpy as np
import pytest
from click.testing import CliRunner

from odometry.errors import ConfigError
from terrain.classification.classifier import TerrainClassifier
from terrain.classification.config import ClassifierConfig
from terrain.classification.own_statistics import (
    Moments,
    OwnStatisticsClassifier,
    own_scaler,
    own_weight,
    used_as,
)
from terrain.cli.verbs.classify import classify
from terrain.errors import ImageError

SIZE = 32


def texture(rng, kind):
    """Pebbles of three sizes, as blocks of one grey."""
    cells = rng.integers(40, 216, (SIZE // kind, SIZE // kind))
    return np.kron(cells, np.ones((kind, kind))).astype(np.uint8)


KINDS = (1, 4, 16)


def images(rng, count=20, kinds=KINDS):
    return [texture(rng, kind) for kind in kinds for _ in range(count)]


@pytest.fixture(scope="module")
def classifier():
    rng = np.random.default_rng(5)
    return TerrainClassifier().fit(images(rng), np.repeat([f"of {k}" for k in KINDS], 20))


def other_camera(image):
    """Blurred and dark."""
    return (cv2.GaussianBlur(image, (0, 0), 0.7) * 0.5).astype(np.uint8)


def test_moments_are_means_and_deviations(rng):
    features, discriminants = rng.normal(3, 2, (40, 5)), rng.normal(size=(40, 2))
    parts = [Moments.of(features[rows], discriminants[rows]) for rows in np.split(range(40), [7])]
    moments = parts[0] + parts[1]
    mean, deviation = moments.means_and_deviations()
    np.testing.assert_allclose(mean, features.mean(axis=0))
    np.testing.assert_allclose(deviation, features.std(axis=0))
    assert moments.spread == pytest.approx(discriminants.var(axis=0).sum())
    assert moments.patches == 40


def test_the_scaler_lies_between_training_and_the_images(classifier, rng):
    scaler = classifier.neighbours.scaler
    features = scaler.mean_ + 3 * scaler.scale_ * rng.normal(1, 1, (200, len(scaler.mean_)))
    moments = Moments.of(features, rng.normal(size=(200, 2)))
    same, own = (own_scaler(scaler, moments, weight) for weight in (0.0, 1.0))
    np.testing.assert_allclose(same.mean_, scaler.mean_)
    np.testing.assert_allclose(same.scale_, scaler.scale_)
    varies = features.std(axis=0) > 0
    np.testing.assert_allclose(own.mean_, features.mean(axis=0))
    np.testing.assert_allclose(own.scale_[varies], features.std(axis=0)[varies])


def test_one_terrain_leaves_the_statistics_of_training(classifier, rng):
    """Its mean says which terrain it is, not which camera."""
    for kind in KINDS:
        own = OwnStatisticsClassifier(classifier)
        shown = images(rng, 15, (kind,))
        answers = own.classify(shown)
        assert own.weight < 0.05
        plain = classifier.classify(shown)
        assert [a.label for a in answers] == [a.label for a in plain]


def test_all_terrains_have_the_weight_of_their_number(classifier, rng):
    own = OwnStatisticsClassifier(classifier)
    for image in images(rng, 30):
        own.see(image)
    assert own.patches == 90
    assert 0.4 < own.weight <= 90 / (90 + 50)
    assert f"({own.patches} patches)" in own.described


def test_another_camera_is_named_more_often(classifier, rng):
    shown = [other_camera(image) for image in images(rng, 30)]
    names = np.repeat([f"of {k}" for k in KINDS], 30)
    own = OwnStatisticsClassifier(classifier)
    for image in shown:
        own.see(image)
    standardised = own.standardised()
    right, before = (np.mean(of.predict(shown) == names) for of in (standardised, classifier))
    assert right >= before
    assert standardised.rejection_distance_ == classifier.rejection_distance_
    weight = own_weight(classifier.neighbours, own._moments)
    assert weight == own.weight


def test_images_in_turn_and_before_any(classifier, rng):
    own = OwnStatisticsClassifier(classifier)
    assert own.standardised() is classifier
    assert own.classify([]) == []
    (answer,) = own.classify([texture(rng, 4)])
    assert answer.label in {"of 4", "unknown"}
    with pytest.raises(ImageError):
        own.classify([np.zeros((8, 8), np.uint8)])


def test_only_the_default_preset_has_them(classifier, rng):
    assert used_as(classifier, ClassifierConfig()) is classifier
    asked = used_as(classifier, ClassifierConfig(own_statistics=True))
    assert isinstance(asked, OwnStatisticsClassifier)
    paper = TerrainClassifier("chen2023").fit(images(rng, 3, (1, 16)), ["a"] * 3 + ["b"] * 3)
    with pytest.raises(ConfigError, match="chen2023"):
        OwnStatisticsClassifier(paper)


def test_the_camera_of_training_is_no_other_one(classifier):
    unsure = copy(classifier)
    unsure.noticed_share_ = 0.4
    assert used_as(unsure, ClassifierConfig(same_camera=True)).noticed_share_ is None
    assert used_as(unsure, ClassifierConfig()).noticed_share_ == 0.4
    with pytest.raises(ConfigError, match="another camera"):
        used_as(unsure, ClassifierConfig(own_statistics=True, same_camera=True))


def test_classify_standardises_by_all_images(classifier, tmp_path, rng):
    classifier.save(tmp_path / "a.model")
    for kind in KINDS:
        (tmp_path / "shown" / f"of {kind}").mkdir(parents=True)
        for i in range(4):
            path = tmp_path / "shown" / f"of {kind}" / f"{i}.png"
            cv2.imwrite(str(path), other_camera(texture(rng, kind)))
    arguments = [str(tmp_path / "a.model"), str(tmp_path / "shown")]
    said = CliRunner().invoke(classify, [*arguments, "--own-statistics"])
    assert said.exit_code == 0, said.output
    assert "standardised by the images' own statistics (12 patches)" in said.stderr
    assert "standardised" not in CliRunner().invoke(classify, arguments).stderr
