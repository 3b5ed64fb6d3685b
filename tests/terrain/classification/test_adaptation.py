"""A few photographs of a new camera, beside a trained model."""

import cv2
import numpy as np
import pytest
from click.testing import CliRunner

from terrain.classification import adaptation
from terrain.classification.adaptation import ALONE, MIXED, OLD, _in_parts, adapt, clearly_best
from terrain.classification.classifier import TerrainClassifier
from terrain.classification.model_file import read_model, write_model
from terrain.classification.neighbours.validation import Samples
from terrain.classification.old_samples import SamplesBesideOld
from terrain.classification.photographs.patches import LabelledPatches
from terrain.classification.photographs.trained_on import TrainedOn
from terrain.cli.verbs.train import train
from terrain.errors import ModelFileError, PatchError


def samples(seed, count, shift, scale, groups):
    """Two classes apart along the first feature, as a camera of that shift and scale has them."""
    rng = np.random.default_rng(seed)
    codes = np.arange(count) % 2
    features = rng.normal(size=(count, 4)) + np.outer(codes, [4.0, 0, 0, 0])
    return Samples(shift + scale * features, codes, np.arange(count) % groups)


def test_old_samples_are_moved_to_where_the_new_camera_sees_them():
    new, old = samples(1, 4000, 7.0, 3.0, 8), samples(2, 4000, -2.0, 0.5, 8)
    beside = SamplesBesideOld(new.features, new.codes, new.groups, old.features, old.codes)
    features, codes, copies, shares = beside.with_copies(np.arange(4000), None)
    assert copies == 4000
    np.testing.assert_allclose(shares, 1 / 8000, atol=1e-12)
    np.testing.assert_array_equal(features[:4000], new.features)
    np.testing.assert_array_equal(codes[4000:], old.codes)
    expected = 7.0 + 3.0 * (old.features + 2.0) / 0.5
    np.testing.assert_allclose(features[4000:], expected, atol=0.6)


def test_the_share_of_terrains_moves_nothing():
    new, old = samples(1, 4000, 0.0, 1.0, 8), samples(2, 4000, 0.0, 1.0, 8)
    rare = (new.codes == 0) | (np.arange(4000) < 800)
    part = SamplesBesideOld(
        new.features[rare], new.codes[rare], new.groups[rare], old.features, old.codes
    )
    features, _, count, _ = part.with_copies(np.arange(rare.sum()), None)
    np.testing.assert_allclose(features[-count:], old.features, atol=0.3)


def test_only_rows_that_are_learned_from_tell_where_to():
    new, old = samples(1, 400, 0.0, 1.0, 2), samples(2, 400, 5.0, 2.0, 2)
    beside = SamplesBesideOld(new.features, new.codes, new.groups, old.features, old.codes)
    rows = np.arange(200)
    changed = SamplesBesideOld(
        np.concatenate([new.features[:200], np.full((200, 4), 1e6)]),
        new.codes, new.groups, old.features, old.codes,
    )  # fmt: skip
    for one, other in zip(
        beside.with_copies(rows, None), changed.with_copies(rows, None), strict=True
    ):
        np.testing.assert_array_equal(one, other)


@pytest.fixture(scope="module")
def camera(tmp_path_factory, training_patches):
    """Writes photographs of a camera: so many of each terrain, changed."""

    def written(count, change, first=0):
        root = tmp_path_factory.mktemp("camera")
        images, labels, groups = training_patches
        for i in range(0, len(images), 4):
            if first <= int(groups[i].split()[1]) < first + count:
                (root / labels[i]).mkdir(exist_ok=True)
                whole = np.block([images[i : i + 2], images[i + 2 : i + 4]])
                cv2.imwrite(str(root / labels[i] / f"{i:03d}.png"), change(whole))
        return root

    return written


def same(image):
    return image


def exchanged(image):
    """A camera to which each terrain looks as the other did."""
    blurred = cv2.GaussianBlur(image, (0, 0), 2)
    return 255 - blurred


@pytest.fixture(scope="module")
def adapted(classifier, camera):
    """From photographs of a camera that exchanges the terrains."""
    return adapt(camera(4, exchanged), classifier)


@pytest.mark.slow
def test_where_all_ways_are_equal_the_new_photographs_alone_are_kept(classifier, camera, adapted):
    for found in (adapt(camera(4, same), classifier), adapted):
        assert found.scores == {ALONE: 1.0, MIXED: 1.0, OLD: 1.0}
        assert (found.kept, found.forgotten) == (ALONE, ())
        made, patches = found.training.classifier, found.training.patches
        assert made is not classifier
        assert made.trained_on_ == patches.trained_on
        assert len(made.old_samples_.labels) == len(patches.images)
        assert (made.metres_per_pixel, made.patch_size_px) == (0.006, 32)


def test_what_is_kept_is_what_is_given(classifier, camera, monkeypatch):
    """The way that is clearly best, made to be each: its classifier, and what that learned."""
    root, before = camera(2, same), TrainedOn(image_sums=frozenset({"before"}))
    monkeypatch.setattr(classifier, "trained_on_", before)
    for kept in (MIXED, OLD):
        monkeypatch.setattr(adaptation, "clearly_best", lambda *_, kept=kept: kept)
        found = adapt(root, classifier, rejected_share=0.11)
        made, new = found.training.classifier, found.training.patches.trained_on
        assert found.kept == kept
        if kept == OLD:
            assert made is classifier
        else:
            assert made.trained_on_ == new | before
            assert made.rejected_share == 0.11


def test_one_way_learns_from_the_new_photographs_alone_and_one_from_old_samples_too(
    classifier, camera, monkeypatch
):
    given, fit = [], TerrainClassifier.fit

    def recorded(self, *patches, beside=None, **settings):
        given.append(beside)
        return fit(self, *patches, beside=beside, **settings)

    monkeypatch.setattr(TerrainClassifier, "fit", recorded)
    adapt(camera(1, same), classifier)
    assert [beside is classifier.old_samples_ for beside in given] == [False, True]
    assert given[0] is None


def test_halves_of_a_photograph_are_its_first_and_last_patches():
    groups = ["a", "b", "a", "a", "b", "a", "a"]
    patches = LabelledPatches(groups=groups)
    halves = ["a, half 1", "b, half 1", "a, half 1", "a, half 1", "b, half 2"]
    assert _in_parts(patches).groups == [*halves, "a, half 2", "a, half 2"]


@pytest.mark.parametrize(("gains", "kept"), [((1, 1, 1, 1), MIXED), ((3, -2, 2, -2), ALONE)])
def test_old_samples_are_kept_where_they_help_by_more_than_chance(gains, kept):
    """Four photographs of each of two terrains, ten patches each, of which alone names five."""
    codes, groups = np.repeat([0, 1], 40), np.repeat(np.arange(8), 10)
    alone = np.tile(np.arange(10) < 5, 8)
    mixed = np.concatenate([np.arange(10) < 5 + gain for gain in gains * 2])
    right = {ALONE: alone, MIXED: mixed, OLD: np.zeros(80, dtype=bool)}
    assert mixed.mean() > alone.mean()
    assert clearly_best(codes, right, groups) == kept


def test_an_old_model_that_is_better_than_any_is_kept():
    codes, groups = np.repeat([0, 1], 40), np.repeat(np.arange(8), 10)
    right = {name: np.tile(np.arange(10) < few, 8) for name, few in ((ALONE, 5), (MIXED, 7))}
    assert clearly_best(codes, right | {OLD: codes < 2}, groups) == OLD


def test_a_score_is_of_photographs_that_were_held_out(classifier, adapted):
    alone = TerrainClassifier(metres_per_pixel=0.006)
    patches = adapted.training.patches
    alone.fit(patches.images, patches.labels, patches.groups)
    out_of_fold = alone.cross_validation_
    right = out_of_fold.probabilities.argmax(axis=1) == out_of_fold.codes
    by_class = [right[out_of_fold.codes == code].mean() for code in (0, 1)]
    assert adapted.scores[ALONE] == pytest.approx(np.mean(by_class))
    right = np.asarray(classifier.predict(patches.images)) == np.array(patches.labels)
    labels = np.array(patches.labels)
    assert adapted.scores[OLD] == pytest.approx(
        np.mean([right[labels == name].mean() for name in ("boards", "gravel")])
    )


def test_with_one_photograph_of_a_terrain_the_new_ones_alone_are_learned_from(classifier, camera):
    found = adapt(camera(1, same), classifier)
    assert (found.kept, found.scores) == (ALONE, {})
    assert found.training.classifier.classify(found.training.patches.images[:1])
    assert found.training.patches.groups[0].endswith(".png")


@pytest.mark.slow
def test_terrains_without_new_photographs_are_said_to_be_forgotten(
    training_patches, camera, monkeypatch
):
    images, labels, groups = training_patches
    sky = [np.full((32, 32), 200 + i, np.uint8) for i in range(8)]
    old = TerrainClassifier().fit(
        [*images, *sky], [*labels, *["sky"] * 8], [*groups, *map(str, range(8))]
    )
    root = camera(3, exchanged)
    found = adapt(root, old)
    assert (found.kept, found.forgotten) == (ALONE, ("sky",))
    monkeypatch.setattr(adaptation, "clearly_best", lambda *_: OLD)
    assert adapt(root, old).forgotten == ()  # the model as it is knows them


def test_a_model_file_keeps_samples_and_older_ones_are_refused(classifier, camera, tmp_path):
    classifier.save(tmp_path / "a.model")
    loaded = TerrainClassifier.load(tmp_path / "a.model")
    np.testing.assert_allclose(
        loaded.old_samples_.features, classifier.old_samples_.features, rtol=1e-6
    )
    assert loaded.old_samples_.labels.tolist() == classifier.old_samples_.labels.tolist()
    settings, arrays = read_model(tmp_path / "a.model")
    old = {name: array for name, array in arrays.items() if not name.startswith("sample_")}
    write_model(tmp_path / "old.model", settings, old)
    with pytest.raises(PatchError, match="train it anew"):
        adapt(camera(2, same), TerrainClassifier.load(tmp_path / "old.model"))
    write_model(tmp_path / "bad.model", settings, arrays | {"sample_codes": np.array([9])})
    with pytest.raises(ModelFileError, match="samples"):
        TerrainClassifier.load(tmp_path / "bad.model")


def test_train_adapts_and_says_what_was_kept(model_file, camera, tmp_path):
    root = camera(4, exchanged)
    options = ["--adapt", str(model_file), "--processes", "1"]
    answer = CliRunner().invoke(train, [str(root), "--out", str(tmp_path / "new.model"), *options])
    assert answer.exit_code == 0, answer.output
    assert f"Adapted from {model_file}: balanced accuracy by patch" in answer.stderr
    assert "Kept: the new photographs alone;" in answer.stderr
    loaded = TerrainClassifier.load(tmp_path / "new.model")
    assert (loaded.patch_size_px, loaded.metres_per_pixel) == (32, 0.006)
    for unused in (["--k", "3"], ["--augment"], ["--preset", "fast"], ["--patch-size", "64"]):
        refused = CliRunner().invoke(train, [str(root), "--out", "x", *options, *unused])
        assert refused.exit_code == 2
        assert f"{unused[0]} does nothing with --adapt" in refused.output


def test_train_says_where_one_photograph_cannot_decide(model_file, camera, tmp_path):
    root, out = camera(1, same), tmp_path / "new.model"
    options = ["--adapt", str(model_file), "--processes", "1"]
    answer = CliRunner().invoke(train, [str(root), "--out", str(out), *options])
    assert answer.exit_code == 0, answer.output
    assert "one photograph alone" in answer.stderr
    assert "only the new ones are learned from" in answer.stderr
