"""Classifiers whose features an image network or any other transformer makes."""

import json
import pickle
import zipfile

import cv2
import numpy as np
import pytest
from click.testing import CliRunner
from joblib.externals.loky import get_reusable_executor
from sklearn.base import BaseEstimator, TransformerMixin, clone

from odometry.errors import ConfigError
from terrain.classification.classifier import TerrainClassifier
from terrain.classification.features.network_features import Network, NetworkFeatures
from terrain.classification.model_file import read_model, write_model
from terrain.cli.verbs.train import train
from terrain.errors import ModelFileError, PatchError
from terrain.main_job import run_odometry
from tests.terrain.classification.features.onnx_bytes import tiny_features, tiny_network

TINY = NetworkFeatures(Network("tiny.onnx", tiny_network()), layers=("r1", "r2"))
NEW = np.random.default_rng(11).integers(0, 256, (4, 32, 32), dtype=np.uint8)


class Moments(TransformerMixin, BaseEstimator):
    """Mean and deviation of the image and its rows' differences, centred on the training images."""

    def fit(self, X, y=None):
        assert y is None, "the terrain is not given"
        self.centre_ = np.mean([self._of(image) for image in X], axis=0)
        return self

    def transform(self, X):
        return np.array([self._of(image) for image in X]) - self.centre_

    def _of(self, image):
        steps = np.diff(image.astype(float), axis=0)
        return [image.mean(), image.std(), steps.std(), np.abs(steps).mean()]


@pytest.fixture(scope="module")
def trained(training_patches):
    return TerrainClassifier(features=TINY, metres_per_pixel=0.006).fit(*training_patches)


def answers(classifier, images=NEW):
    return [(a.label, a.distance, a.probabilities) for a in classifier.classify(images)]


def test_a_network_names_the_terrain_by_its_own_features(trained, training_patches):
    images, labels, groups = training_patches
    assert np.mean(trained.predict(images) == np.array(labels)) > 0.95
    table = np.array([tiny_features(image, ("r1", "r2")) for image in images])
    of_table = TerrainClassifier().fit(table, labels, groups)
    assert trained.n_features_in_ == of_table.n_features_in_ == 20
    assert trained.n_neighbors_ == of_table.n_neighbors_
    assert trained.rejection_distance_ == pytest.approx(of_table.rejection_distance_, rel=1e-3)


def test_a_model_file_holds_the_network(trained, tmp_path):
    trained.save(tmp_path / "a.model")
    loaded = TerrainClassifier.load(tmp_path / "a.model")
    assert answers(loaded) == answers(trained)
    assert loaded.features.network.name == "tiny.onnx"
    assert loaded.features.layers == ("r1", "r2")
    loaded.save(tmp_path / "b.model")
    assert (tmp_path / "b.model").read_bytes() == (tmp_path / "a.model").read_bytes()
    with zipfile.ZipFile(tmp_path / "a.model") as archive:
        kept = json.loads(archive.read("header.json"))["settings"]["features"]
    assert set(kept) == {"network", "sha256", "layers", "input_range"}


def test_a_file_with_another_network_is_refused(trained, tmp_path):
    trained.save(tmp_path / "a.model")
    settings, arrays = read_model(tmp_path / "a.model")
    other = NetworkFeatures(
        Network("other.onnx", tiny_network(16)), layers=("r1", "r2")
    ).read_network()
    exchanged = arrays | {"network": np.frombuffer(other.part_.data, np.int8)}
    write_model(tmp_path / "b.model", settings, exchanged)
    with pytest.raises(ModelFileError, match=r"not the part of tiny\.onnx"):
        TerrainClassifier.load(tmp_path / "b.model")
    arrays.pop("network")
    write_model(tmp_path / "c.model", settings, arrays)
    with pytest.raises(ModelFileError, match="'network'"):
        TerrainClassifier.load(tmp_path / "c.model")


def test_a_model_of_fewer_channels_than_its_network_gives_is_refused(trained, tmp_path):
    trained.save(tmp_path / "a.model")
    settings, arrays = read_model(tmp_path / "a.model")
    settings["features"]["layers"] = ["r2"]
    write_model(tmp_path / "b.model", settings, arrays)
    with pytest.raises(ModelFileError, match="do not fit"):
        TerrainClassifier.load(tmp_path / "b.model")


def test_any_transformer_makes_features_and_learns_without_labels(training_patches, tmp_path):
    images, labels, groups = training_patches
    given = Moments()
    classifier = TerrainClassifier(features=given).fit(images, labels, groups)
    table = given.fit(images).transform(images)
    expected = TerrainClassifier().fit(table, labels, groups)
    np.testing.assert_array_equal(classifier.predict_proba(images), expected.predict_proba(table))
    with pytest.raises(ModelFileError, match="not a Moments; pickle or joblib"):
        classifier.save(tmp_path / "a.model")
    copy = pickle.loads(pickle.dumps(classifier))  # noqa: S301
    assert answers(copy) == answers(classifier)


def test_the_given_transformer_stays_as_it_is_and_clones_with_the_classifier(training_patches):
    given = Moments()
    classifier = TerrainClassifier(features=given).fit(*training_patches)
    assert not hasattr(given, "centre_")
    assert classifier.features is given
    copy = clone(classifier)
    assert isinstance(copy.features, Moments)
    assert copy.features is not given
    assert "features" in TerrainClassifier(features=given).get_params(deep=False)


@pytest.mark.parametrize("colour", [True, False])
def test_a_transformer_sees_colour_only_where_it_is_requested(training_patches, colour):
    seen = []

    class Listening(Moments):
        def transform(self, X):
            seen.extend(np.ndim(image) for image in X)
            return super().transform(X)

    images, labels, groups = training_patches
    tinted = [np.stack([image, image, image // 2], axis=-1) for image in images]
    classifier = TerrainClassifier(features=Listening(), colour=colour)
    classifier.fit(tinted, labels, groups).classify(tinted[:1])
    assert set(seen) == {3 if colour else 2}
    assert classifier.colour_ is colour


@pytest.mark.parametrize(
    ("table", "message"),
    [
        (lambda n: np.zeros((n, 2, 2)), r"gives float64 \(\d+, 2, 2\) for"),
        (lambda n: np.zeros((n - 1, 2)), "a row for each"),
        (lambda n: np.full((n, 2), "a"), "expected a table of numbers"),
        (lambda n: np.full((n, 2), np.nan), "not finite"),
    ],
)
def test_what_is_no_table_of_numbers_is_refused(training_patches, table, message):
    class Wrong(Moments):
        def transform(self, X):
            return table(len(X))

    with pytest.raises(PatchError, match=message):
        TerrainClassifier(features=Wrong()).fit(*training_patches)


def test_the_paper_has_its_own_features(training_patches):
    with pytest.raises(ConfigError, match="'chen2023' makes its own features"):
        TerrainClassifier("chen2023", features=TINY).fit(*training_patches)


def test_the_main_job_sees_by_the_network_of_the_file(trained, across_run, tmp_path):
    trained.save(tmp_path / "a.model")
    result = run_odometry(across_run, model=tmp_path / "a.model", terrain="gravel")
    assert [change.terrain for change in result.changes] == ["boards", "gravel"]


@pytest.fixture(scope="module")
def photos(tmp_path_factory, training_patches):
    root = tmp_path_factory.mktemp("photos")
    for place, (image, label) in enumerate(zip(*training_patches[:2], strict=True)):
        (root / label).mkdir(exist_ok=True)
        cv2.imwrite(str(root / label / f"{place:03d}.png"), image)
    (root / "tiny.onnx").write_bytes(tiny_network())
    return root


def called(photos, *options):
    network = ["--features", str(photos / "tiny.onnx")] if "--no-network" not in options else []
    rest = [option for option in options if option != "--no-network"]
    return CliRunner().invoke(train, [str(photos), *network, *rest])


def test_train_takes_a_network_and_the_model_works_without_its_file(photos, tmp_path):
    model = tmp_path / "terrain.model"
    answer = called(photos, "--out", str(model), "--layers", "relu1, r2", "--input-range", "0:1")
    assert answer.exit_code == 0, answer.output
    assert "10 channels of layers r1, r2 of tiny.onnx" in answer.stderr
    loaded = TerrainClassifier.load(model)
    assert loaded.features.input_range == (0.0, 1.0)
    assert loaded.features.layers == ("r1", "r2")
    assert str(photos) not in repr(loaded.features.network)


def test_processes_that_share_the_patches_give_the_same_model(trained, training_patches, tmp_path):
    shared = TerrainClassifier(features=TINY, metres_per_pixel=0.006)
    shared.fit(*training_patches, processes=2)
    get_reusable_executor().shutdown(wait=True)
    for name, model in (("a", trained), ("b", shared)):
        model.save(tmp_path / name)
    assert (tmp_path / "a").read_bytes() == (tmp_path / "b").read_bytes()


@pytest.mark.parametrize(
    ("options", "code", "message"),
    [
        (["--layers", "r9"], 1, "no layer 'r9'"),
        (["--input-range", "1"], 2, "expected LOW:HIGH"),
        (["--input-range", "1:0"], 1, "expected low and high"),
        (["--no-network", "--layers", "r1"], 2, "--layers is of a network"),
        (["--preset", "chen2023"], 1, "'chen2023' makes its own features"),
    ],
)
def test_train_refuses_what_is_no_choice_of_layers(photos, tmp_path, options, code, message):
    answer = called(photos, "--out", str(tmp_path / "a.model"), *options)
    assert message in answer.output + str(answer.exception)
    assert answer.exit_code == code
    assert not (tmp_path / "a.model").exists()
