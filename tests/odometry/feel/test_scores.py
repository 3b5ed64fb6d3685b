import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from sklearn.metrics import balanced_accuracy_score, roc_auc_score

from odometry.feel.scores import (
    area,
    balanced_accuracy,
    bootstrap_interval,
    calibration_error,
    confusion,
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
