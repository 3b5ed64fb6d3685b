import numpy as np
import pytest
from scipy.stats import sem
from sklearn.metrics import balanced_accuracy_score

from terrain.classification.held_out import (
    balanced_accuracy_interval,
    confusion,
    confusion_text,
    paired_difference,
    photo_votes,
    rejection_roc_area,
)
from terrain.classification.neighbours.validation import balanced_accuracy


def test_confusion_and_balanced_accuracy_by_hand():
    codes = np.array([0, 0, 0, 0, 1, 1])
    answers = np.array([0, 0, 0, 1, 1, 2])
    table = confusion(codes, answers, 3)
    np.testing.assert_array_equal(table, [[3, 1, 0], [0, 1, 1], [0, 0, 0]])
    assert balanced_accuracy(codes, answers) == (3 / 4 + 1 / 2) / 2
    lines = confusion_text(table, ["sand", "soil", "tile"]).splitlines()
    assert lines[0].split() == ["sand", "soil", "tile", "patches"]
    assert lines[1].split() == ["sand", "75.0", "25.0", "0.0", "4"]
    assert lines[3].split() == ["tile", "0.0", "0.0", "0.0", "0"]


def test_balanced_accuracy_is_that_of_scikit_learn_bit_by_bit(rng):
    for classes in range(2, 12):
        codes = np.append(np.arange(classes), rng.integers(0, classes, 90))
        answers = np.where(rng.random(len(codes)) < 0.7, codes, rng.permutation(codes))
        assert balanced_accuracy(codes, answers) == balanced_accuracy_score(codes, answers)


def test_patches_of_a_photograph_vote_with_their_probabilities():
    probabilities = np.array([[0.6, 0.4], [0.1, 0.9], [0.6, 0.4], [0.8, 0.2]])
    photos = np.array(["b", "b", "b", "a"])
    codes, answers, rows = photo_votes(np.array([1, 1, 1, 0]), probabilities, photos)
    np.testing.assert_array_equal(codes, [0, 1])
    np.testing.assert_array_equal(answers, [0, 1])
    np.testing.assert_array_equal(rows, [3, 0])


def test_the_interval_of_independent_answers_is_binomial(rng):
    codes = np.repeat([0, 1], 400)
    answers = np.where(rng.random(800) < np.where(codes == 0, 0.9, 0.7), codes, 1 - codes)
    low, high = balanced_accuracy_interval(codes, answers, np.arange(800), rng)
    recalls = [np.mean(answers[codes == c] == c) for c in (0, 1)]
    sigma = np.sqrt(sum(r * (1 - r) / 400 for r in recalls)) / 2
    assert low == pytest.approx(np.mean(recalls) - 1.96 * sigma, abs=0.004)
    assert high == pytest.approx(np.mean(recalls) + 1.96 * sigma, abs=0.004)


def test_patches_of_one_photograph_are_one_piece_of_evidence(rng):
    """Twenty equal patches a photograph: the interval of photographs, not of patches."""
    codes = np.repeat([0, 1], 50)
    answers = np.where(rng.random(100) < 0.8, codes, 1 - codes)
    alone = balanced_accuracy_interval(codes, answers, np.arange(100), np.random.default_rng(1))
    many = balanced_accuracy_interval(
        np.repeat(codes, 20),
        np.repeat(answers, 20),
        np.repeat(np.arange(100), 20),
        np.random.default_rng(1),
    )
    assert many == pytest.approx(alone, abs=1e-12)


def test_few_photographs_that_are_all_right_are_no_certainty(rng):
    codes = np.repeat([0, 1], 50)
    low, high = balanced_accuracy_interval(codes, codes, codes, rng)  # one photograph a class
    assert low < 0.4
    assert high == 1.0
    many, _ = balanced_accuracy_interval(codes, codes, np.arange(100), rng)
    assert 0.95 < many < 1.0
    assert balanced_accuracy_interval(codes, 1 - codes, codes, rng) == (
        0.0,
        pytest.approx(1 - low, abs=0.02),
    )


def test_roc_area_counts_pairs(rng):
    known, unknown = rng.integers(0, 8, 30).astype(float), rng.integers(2, 12, 20).astype(float)
    wins = unknown[:, None] - known
    assert rejection_roc_area(known, unknown) == pytest.approx(np.mean((np.sign(wins) + 1) / 2))


def test_a_difference_and_its_error_are_those_of_photographs(rng):
    """Photographs of ten patches each: mean and standard error of what they gain."""
    codes, groups = np.repeat([0, 1], [60, 40]), np.repeat(np.arange(10), 10)
    right, other = rng.random((2, 100)) < [[0.7], [0.5]]
    gains = (right.astype(float) - other).reshape(10, 10).mean(axis=1)
    difference, error = paired_difference(codes, right, other, groups)
    assert difference == pytest.approx((gains[:6].mean() + gains[6:].mean()) / 2)
    assert error == pytest.approx(np.hypot(sem(gains[:6]), sem(gains[6:])) / 2)
    assert paired_difference(codes, right, other, codes)[1] == np.inf
