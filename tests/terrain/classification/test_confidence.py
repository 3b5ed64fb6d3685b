"""How probable an answer is, by how far its image is from training."""

from dataclasses import replace

import cv2
import numpy as np
import pytest
import skimage.data

from terrain.classification import learning
from terrain.classification.classifier import TerrainClassifier
from terrain.classification.confidence import (
    MOST,
    WEIGHTS,
    AnswerConfidence,
    evidence,
    weight_of_others,
)
from terrain.classification.confidence_learning import (
    TERRAINS,
    Shown,
    altered_patch,
    learned_confidence,
    other_terrains,
)
from terrain.classification.model_file import read_model, write_model
from terrain.classification.neighbours.validation import Fold, Samples
from terrain.errors import ModelFileError
from tests.terrain.classification.test_no_ground import ground, photographs

NEAR, FAR = np.array([0.1]), np.array([3.0])
VOTES = np.array([[0.1, 0.7, 0.2]])


def known(weights=(2.0, 0.5, -1.0, -1.0)):
    return AnswerConfidence(np.array(weights))


def drawn(weights, count, seed):
    rng = np.random.default_rng(seed)
    numbers = rng.normal(0, 1, (count, 3))
    right = rng.random(count) < 1 / (1 + np.exp(-weights[0] - numbers @ weights[1:]))
    return numbers, right


def test_it_finds_the_weights_that_answers_were_drawn_with():
    weights = np.array([0.5, 0.8, -1.0, -0.4])
    tables = [(1.0, *drawn(weights, 20_000, seed)) for seed in range(3)]
    np.testing.assert_allclose(AnswerConfidence.of(tables).weights, weights, atol=0.05)


def test_each_table_counts_by_its_weight_and_not_by_its_length():
    numbers = np.zeros((300, 3))
    numbers[:, 0] = np.linspace(-1, 1, 300)
    long, short = (np.resize([True, True, False], n) for n in (300, 30))
    tables = [(0.5, numbers, long), (0.5, numbers[::10], ~short)]
    found = AnswerConfidence.of(tables).weights[0]
    assert found == pytest.approx(0.0, abs=0.02)  # of two thirds and one third


def test_without_right_or_without_wrong_answers_nothing_is_learned():
    numbers = np.zeros((4, 3))
    for answer in (True, False):
        assert AnswerConfidence.of([(1.0, numbers, np.full(4, answer))]) is None


def test_what_is_farther_away_is_less_probable():
    sure = [
        known().applied(VOTES, distance, displacement).max()
        for distance, displacement in ((NEAR, NEAR), (NEAR, FAR), (FAR, FAR))
    ]
    assert sure[0] > sure[1] > sure[2]
    score = 2.0 + 0.5 * np.log(0.7 / 0.3) - np.log(0.1) - np.log(3.0)
    assert sure[1] == pytest.approx(1 / (1 + np.exp(-score)))


@pytest.mark.parametrize("intercept", [-50.0, -1.0, 0.0, 1.0, 50.0])
def test_probabilities_add_up_and_the_likeliest_stays_the_likeliest(intercept):
    votes = np.random.default_rng(0).dirichlet(np.ones(4), 200)
    far = np.random.default_rng(1).uniform(0, 4, (2, 200))
    given = known((intercept, 0.5, -1.0, -1.0)).applied(votes, *far)
    np.testing.assert_allclose(given.sum(axis=1), 1.0)
    assert np.all(given >= 0)
    np.testing.assert_array_equal(given.argmax(axis=1), votes.argmax(axis=1))
    assert np.all((given.max(axis=1) > 0.25) & (given.max(axis=1) <= MOST + 1e-12))


def test_evidence_of_what_is_on_a_sample_or_infinitely_far_is_finite():
    unanimous = np.array([[1.0, 0.0], [0.5, 0.5]])
    given = evidence(unanimous, np.array([0.0, 1e300]), np.array([0.0, 1e300]))
    assert np.isfinite(given).all()
    np.testing.assert_allclose(known().applied(unanimous, FAR[[0, 0]], FAR[[0, 0]]).sum(axis=1), 1)


def test_each_patch_is_judged_by_a_model_that_was_trained_without_its_photograph():
    groups, rows = np.repeat(list("abcd"), 5), np.arange(20)
    shown = Shown(np.zeros((20, 1)), np.zeros((20, 10)), np.zeros(20, int), groups)
    things, other = (replace(shown, groups=np.repeat([of], 20)) for of in ("thing", "other"))
    judged = set()

    class Answers:
        model = "all"

        def table(self, model, held, _):
            judged.update((model, group) for group in held.groups.tolist())
            return np.zeros((len(held.codes), 3)), np.arange(len(held.codes)) % 2 == 0

    folds = [Fold(rows[10:], rows[:10], "of c, d"), Fold(rows[:10], rows[10:], "of a, b")]
    samples = Samples(np.zeros((20, 1)), shown.codes, groups)
    not_known = [(0.25, things), (0.25, other)]
    learned_confidence(Answers(), folds, samples, (shown, shown), not_known)
    apart = {("of c, d", "a"), ("of c, d", "b"), ("of a, b", "c"), ("of a, b", "d")}
    assert judged == {*apart, ("all", "thing"), ("all", "other")}


def test_the_share_of_terrain_that_is_not_known_is_that_of_laplaces_rule_for_few_terrains():
    for terrains in (2, 3):
        weight = weight_of_others(terrains)
        assert weight / (weight + WEIGHTS[0]) == pytest.approx(1 / (terrains + 1))
    assert weight_of_others(4) == 0


def test_terrain_that_a_model_knows_by_its_name_is_no_other_terrain():
    assert other_terrains(["mud", "tile"]) == TERRAINS
    assert other_terrains(["Wet grass", "tile"]) == ("brick", "gravel")
    assert other_terrains([*TERRAINS]) == ()


@pytest.mark.slow
def test_a_model_of_two_terrains_is_less_sure_of_others_and_names_its_own_as_before(
    model, monkeypatch
):
    monkeypatch.setattr(learning, "other_terrains", lambda _: ())
    without = TerrainClassifier().fit(*photographs(1, photos=40))
    rng = np.random.default_rng(5)
    between = [ground(rng, 1.5, spread, np.ones(3)) for spread in np.linspace(10, 20, 8)]
    sure, less = (
        np.mean([of.confidence for of in by.classify(between)]) for by in (without, model)
    )
    assert less < sure - 0.1
    own = photographs(2, photos=20)[0]
    names = [[of.label for of in by.classify(own)] for by in (without, model)]
    assert names[0] == names[1]


@pytest.mark.slow
def test_altered_images_and_things_are_less_sure_than_photographs_held_out(model):
    images, labels, _ = photographs(2, photos=20)
    own = model.classify(images)
    right = np.mean(model.predict(images) == labels)
    sure = np.mean([of.confidence for of in own])
    assert right - 0.1 < sure < right + 0.05  # too low: two terrains teach little of others
    blurred = model.classify([cv2.GaussianBlur(image, (0, 0), 2.0) for image in images])
    things = model.classify([skimage.data.coffee(), skimage.data.rocket()])
    assert np.mean([of.confidence for of in blurred]) < 0.8
    assert max(of.confidence for of in things) < 0.7


def test_the_likeliest_terrain_is_that_of_the_votes(model):
    images = photographs(2, photos=2)[0]
    answers = model.classify(images)
    names = [max(of.probabilities, key=of.probabilities.get) for of in answers]
    assert model.predict(images).tolist() == names
    assert all(of.confidence == max(of.probabilities.values()) for of in answers)


def test_altered_patches_are_always_the_same_and_keep_their_scale_where_it_is_known():
    patch = photographs(3, photos=1)[0][0]
    altered = altered_patch(patch, is_to_scale=True)
    assert altered.shape == patch.shape
    assert altered.dtype == np.uint8
    np.testing.assert_array_equal(altered, altered_patch(patch, is_to_scale=True))
    grey = [altered_patch(patch, is_to_scale=of).mean(axis=2).ravel() for of in (True, False)]
    to_scale, reduced = (np.corrcoef(patch.mean(axis=2).ravel(), of)[0, 1] for of in grey)
    assert to_scale > 0.3 > abs(reduced)


def test_a_model_file_keeps_it_and_older_ones_give_the_votes(model, tmp_path):
    images = photographs(2, photos=2)[0]
    model.save(tmp_path / "a.model")
    assert TerrainClassifier.load(tmp_path / "a.model").classify(images) == model.classify(images)
    settings, arrays = read_model(tmp_path / "a.model")
    old = {name: of for name, of in arrays.items() if name != "confidence_weights"}
    write_model(tmp_path / "old.model", settings, old)
    before = TerrainClassifier.load(tmp_path / "old.model")
    assert before.confidence_ is None
    for now, then in zip(model.classify(images), before.classify(images), strict=True):
        votes = {"confidence": then.confidence, "probabilities": then.probabilities}
        assert replace(now, **votes, probability_right=None) == then
    del (without := dict(arrays))["run_photograph_limits"]
    for bad in (arrays | {"confidence_weights": np.ones(3)}, without):
        write_model(tmp_path / "bad.model", settings, bad)
        with pytest.raises(ModelFileError, match=r"weights of the confidence|limits of the looks"):
            TerrainClassifier.load(tmp_path / "bad.model")
