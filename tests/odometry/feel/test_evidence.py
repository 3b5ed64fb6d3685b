import numpy as np
import pytest

from odometry.feel.evidence import (
    Calibration,
    Stretches,
    calibrated,
    gathered,
    softmax,
    stretch_numbers,
)

NAMES = ("a", "b", "c")


def simulated(count, boast, windows=1, shared=0.0, seed=0):
    """Log likelihoods of K unit Gaussians, mean of so many windows, `boast` times too certain."""
    rng = np.random.default_rng(seed)
    codes = rng.integers(3, size=count)
    noise = np.sqrt(shared) * rng.normal(size=(count, 1, 3))
    noise = noise + np.sqrt(1 - shared) * rng.normal(size=(count, windows, 3))
    left = noise[:, :, :] + 1.2 * (np.eye(3)[codes][:, None])
    squared = ((left[:, :, None] - 1.2 * np.eye(3)) ** 2).sum(axis=3).mean(axis=1)
    labels = np.array(NAMES, dtype=object)[codes]
    return Stretches(
        labels, np.arange(count), np.full(count, float(windows)), -boast * squared / 2, codes * 0.0
    )


def test_the_temperature_is_found():
    _, calibration = calibrated(simulated(4000, 3.0), simulated(500, 3.0, 5, seed=1), NAMES)
    assert calibration.temperature == pytest.approx(3.0, rel=0.15)
    assert calibration.outliers <= 0.02


def test_windows_that_repeat_each_other_count_as_one():
    alone = simulated(4000, 1.0)
    _, free = calibrated(alone, simulated(2000, 1.0, 5, seed=2), NAMES)
    _, same = calibrated(alone, simulated(2000, 1.0, 5, shared=1.0, seed=2), NAMES)
    assert free.correlation <= 0.1
    assert same.correlation >= 0.7
    assert Calibration(1.0, 0.0, 1.0).worth(np.array([7.0])) == pytest.approx(1.0)
    assert Calibration(1.0, 0.0, 0.0).worth(np.array([7.0])) == pytest.approx(7.0)


def test_no_answer_is_surer_than_outliers_allow():
    calibration = Calibration(1.0, 0.1, 0.0)
    told = calibration.probabilities(np.array([[0.0, -1e6, -1e6]]), np.array([50.0]))
    np.testing.assert_allclose(told, [[0.9 + 0.1 / 3, 0.1 / 3, 0.1 / 3]])
    np.testing.assert_allclose(softmax(np.zeros((1, 3))), 1 / 3)


def test_stretches_hold_windows_of_one_run_and_terrain():
    begins_s = np.tile(np.arange(0.0, 30.0), 2)
    runs = np.repeat([4, 9], 30)
    labels = np.where(begins_s < 15, "a", "b").astype(object)
    parts = stretch_numbers(begins_s, runs, labels, 10.0)
    for part in np.unique(parts):
        of = parts == part
        assert len(set(runs[of])) == len(set(labels[of])) == 1
        assert np.ptp(begins_s[of]) < 10.0
    scores = (np.column_stack([begins_s, begins_s]), begins_s)
    found = gathered(parts, labels, runs, scores, steps=1)
    assert len(found) == len(np.unique(parts)) == 8
    assert found.windows.sum() == 60
