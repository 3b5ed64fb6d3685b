import numpy as np
import pytest

from odometry.feel.assessment.evidence import (
    Calibration,
    Stretches,
    calibrated_stretches,
    calibrated_windows,
    gathered,
    softmax,
    stretch_numbers,
)
from odometry.feel.assessment.scores import calibration_error

NAMES = ("a", "b", "c")


def simulated(count, boast, windows=1, shared=0.0, seed=0):
    """Labels, and log likelihoods (N, windows, 1, K) of unit Gaussians, `boast` times too sure."""
    rng = np.random.default_rng(seed)
    codes = rng.integers(3, size=count)
    noise = np.sqrt(shared) * rng.normal(size=(count, 1, 3))
    noise = noise + np.sqrt(1 - shared) * rng.normal(size=(count, windows, 3))
    left = noise + 1.2 * (np.eye(3)[codes][:, None])
    squared = ((left[:, :, None] - 1.2 * np.eye(3)) ** 2).sum(axis=3)
    return np.array(NAMES, dtype=object)[codes], -boast * squared[:, :, None] / 2


def together(calibration, labels, log_likelihoods):
    count, windows, *kinds = log_likelihoods.shape
    evidence = calibration.evidence(log_likelihoods.reshape(count * windows, *kinds))
    means = evidence.reshape(count, windows, 3).mean(axis=1)
    nothing = np.zeros((count, 3, 2))
    return Stretches(
        labels, np.arange(count), np.full(count, float(windows)), means, nothing[:, 0, 0], nothing
    )


def test_the_temperature_is_found():
    labels, kinds = simulated(4000, 3.0)
    _, calibration = calibrated_windows(kinds[:, 0], labels, NAMES)
    assert calibration.temperatures[0] == pytest.approx(3.0, rel=0.2)
    assert calibration.outliers <= 0.05


def test_two_kinds_of_classifiers_that_know_more_are_better_together():
    rng = np.random.default_rng(5)
    codes = rng.integers(3, size=4000)
    both = 1.2 * np.eye(3)[codes][:, None] + rng.normal(size=(4000, 2, 3))
    kinds = -((both[:, :, None] - 1.2 * np.eye(3)) ** 2).sum(axis=3) / 2 * np.array([[3.0], [0.5]])
    labels = np.array(NAMES, dtype=object)[codes]
    together_score, calibration = calibrated_windows(kinds, labels, NAMES)
    np.testing.assert_allclose(calibration.temperatures, [3.0, 0.5], rtol=0.25)
    for kind in range(2):
        assert together_score < calibrated_windows(kinds[:, [kind]], labels, NAMES)[0] - 0.05
    assert calibration_error(labels, np.exp(calibration.evidence(kinds)), NAMES) < 0.03


def test_windows_that_repeat_each_other_count_as_one():
    labels, kinds = simulated(4000, 1.0)
    _, windows = calibrated_windows(kinds[:, 0], labels, NAMES)
    _, free = calibrated_stretches(windows, together(windows, *simulated(2000, 1.0, 5)), NAMES)
    _, same = calibrated_stretches(windows, together(windows, *simulated(2000, 1.0, 5, 1.0)), NAMES)
    assert free.correlation <= 0.1
    assert same.correlation >= 0.7
    assert Calibration((1.0,), 0.0, 1.0).worth(np.array([7.0])) == pytest.approx(1.0)
    assert Calibration((1.0,), 0.0, 0.0).worth(np.array([7.0])) == pytest.approx(7.0)


def test_no_window_is_surer_than_outliers_allow():
    calibration = Calibration((1.0,), 0.1, 0.0)
    evidence = calibration.evidence(np.array([[[0.0, -1e6, -1e6]]]))
    np.testing.assert_allclose(np.exp(evidence), [[0.9 + 0.1 / 3, 0.1 / 3, 0.1 / 3]])
    found = calibration.probabilities(evidence, np.ones(1))
    np.testing.assert_allclose(found, np.exp(evidence))
    np.testing.assert_allclose(softmax(np.zeros((1, 3))), 1 / 3)


def test_one_wrong_window_cannot_outvote_many():
    calibration = Calibration((1.0,), 0.05, 0.0)
    windows = np.array([[1.0, 0.0, 0.0]] * 9 + [[-1e6, 0.0, -1e6]])[:, None]
    found = calibration.probabilities(
        calibration.evidence(windows).mean(axis=0)[None], np.array([10.0])
    )
    assert found[0].argmax() == 0


def test_stretches_hold_windows_of_one_run_and_terrain():
    begins_s = np.tile(np.arange(0.0, 30.0), 2)
    runs = np.repeat([4, 9], 30)
    labels = np.where(begins_s < 15, "a", "b").astype(object)
    parts = stretch_numbers(begins_s, runs, labels, 10.0)
    for part in np.unique(parts):
        of = parts == part
        assert len(set(runs[of])) == len(set(labels[of])) == 1
        assert np.ptp(begins_s[of]) < 10.0
    evidence = np.column_stack([begins_s, begins_s])
    windows = Stretches(labels, runs, np.ones(60), evidence, begins_s, evidence[:, None])
    found = gathered(windows, parts, steps=1)
    assert len(found) == len(np.unique(parts)) == 8
    assert found.windows.sum() == 60
    np.testing.assert_allclose(found.evidence[:, 0], found.novelty)
    np.testing.assert_allclose(found.offsets[:, 0], found.evidence)
