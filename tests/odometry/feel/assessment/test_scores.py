import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from sklearn.metrics import balanced_accuracy_score, roc_auc_score

from odometry.feel.assessment.calibration_words import calibration_words
from odometry.feel.assessment.scores import (
    area,
    balanced_accuracy,
    bootstrap_interval,
    calibration_error,
    confusion,
    error_by_chance,
    mean_excess,
)

NAMES = ("a", "b", "c")


@given(st.integers(0, 1000))
def test_balanced_accuracy_and_area_are_those_of_scikit_learn(seed):
    rng = np.random.default_rng(seed)
    labels, answers = (rng.choice(NAMES, size=60, p=[0.6, 0.3, 0.1]) for _ in range(2))
    if len(set(labels)) == len(NAMES):
        expected = balanced_accuracy_score(labels, answers)
        assert balanced_accuracy(labels, labels == answers) == pytest.approx(expected)
        assert confusion(labels, answers, NAMES).sum() == 60
    scores, unknown = rng.integers(0, 8, size=60).astype(float), np.arange(60) < 20
    expected = roc_auc_score(unknown, scores)
    assert area(scores[~unknown], scores[unknown]) == pytest.approx(expected)


def test_calibration_error_of_what_is_known():
    rng = np.random.default_rng(1)
    sure = rng.uniform(0.5, 1.0, size=40_000)
    right = rng.random(40_000) < sure
    labels = np.where(right, "a", "b")
    honest = np.column_stack([sure, 1 - sure])
    flipped = np.where(rng.random(40_000)[:, None] < 0.5, honest, honest[:, ::-1])
    labels = np.where(flipped[:, 0] == sure, labels, np.where(labels == "a", "b", "a"))
    assert calibration_error(labels, flipped, ("a", "b")) < 0.02
    boast = np.full((100, 2), 0.5) + np.array([0.4, -0.4])
    labels = np.array(["a", "b"] * 50)
    assert calibration_error(labels, boast, ("a", "b")) == pytest.approx(0.4)


def test_the_interval_is_over_runs_not_windows():
    runs = np.repeat(np.arange(8), 1000)
    labels = np.array(["a", "b"])[runs % 2]
    right = np.isin(runs, (0, 1, 2, 3, 4, 5))  # whole runs are right or wrong
    low, high = bootstrap_interval(labels, right, runs)
    assert low < 0.6
    assert high > 0.9


def answers(count, excess=0.0, runs=None, seed=0):
    """Probabilities (N, 2) and labels that are right less often than they say, by `excess`."""
    rng = np.random.default_rng(seed)
    sure = rng.uniform(0.6, 0.95, count)
    chance = rng.random(count if runs is None else runs)
    groups = np.arange(count) if runs is None else np.arange(count) % runs
    right = chance[groups] < sure - excess
    best = rng.integers(2, size=count)
    labels = np.array(["a", "b"], dtype=object)[np.where(right, best, 1 - best)]
    given = np.where(np.arange(2) == best[:, None], sure[:, None], 1 - sure[:, None])
    return labels, given, groups


def test_chance_explains_the_error_of_probabilities_that_are_exact():
    found = [answers(200, seed=seed) for seed in range(40)]
    errors = [calibration_error(labels, given, ("a", "b")) for labels, given, _ in found]
    by_chance = [error_by_chance(*one) for one in found]
    assert np.mean(by_chance) == pytest.approx(np.mean(errors), rel=0.1)
    together = [answers(200, runs=10, seed=seed) for seed in range(40)]
    errors = [calibration_error(labels, given, ("a", "b")) for labels, given, _ in together]
    assert np.mean([error_by_chance(*one) for one in together]) == pytest.approx(
        np.mean(errors), rel=0.15
    )


def test_chance_does_not_explain_what_is_too_sure():
    labels, given, groups = answers(4000, excess=0.15)
    assert calibration_error(labels, given, ("a", "b")) > 3 * error_by_chance(labels, given, groups)
    assert mean_excess(labels, given, ("a", "b")) == pytest.approx(0.15, abs=0.02)
    of = {
        "calibration_error": 0.15,
        "error_by_chance": 0.02,
        "error_by_chance_of_runs": 0.05,
        "mean_excess": 0.15,
    }
    assert "does not explain this: they are too high" in calibration_words(of)
    assert "too low" in calibration_words(of | {"mean_excess": -0.1})
    assert "chance may explain" in calibration_words(of | {"calibration_error": 0.04})
    assert "chance explains" in calibration_words(of | {"calibration_error": 0.01})
    assert calibration_words({"calibration_error": 0.1}) == ""  # of an older model
