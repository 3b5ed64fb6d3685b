"""What is read of a bias apart from the modes, and where a bias lies beyond it."""

import numpy as np
import pytest

from odometry.modes.follow.gyroscope_bias import (
    BiasReading,
    bias_is_open,
    bias_readings,
    with_reading,
)
from odometry.modes.modes_config import ModesConfig
from odometry.modes.recorded.bank_inputs import BIAS_SIGMA_RAD_S, Signals
from odometry.modes.recorded.heading_check import HeadingCheck

STEP_S, SIZE = 0.02, 1000
STAMPS_S = STEP_S * np.arange(SIZE)
BEYOND_RAD_S = ModesConfig.bias_sigmas * BIAS_SIGMA_RAD_S + 1e-3


def test_what_is_read_is_weighed_with_what_is_believed():
    """Two Gaussians of one quantity; the filter holds the variance by its share of news."""
    mean, covariance = np.array([1.0, 2.0, 0.004]), np.diag([1.0, 1.0, 0.5 * 0.002**2])
    told, left = with_reading(mean, covariance, BiasReading(0.002, 0.001**2), independent=0.5)
    weights = np.array([1 / 0.002**2, 1 / 0.001**2])
    assert told[2] == pytest.approx(weights @ [0.004, 0.002] / weights.sum())
    assert left[2, 2] == pytest.approx(0.5 / weights.sum())
    np.testing.assert_array_equal(told[:2], mean[:2])


def test_a_bias_that_is_another_one_replaces_what_was_believed():
    mean, covariance = np.zeros(3), np.diag([1.0, 1.0, 0.001**2])
    told, left = with_reading(mean, covariance, BiasReading(0.06, 0.001**2), independent=1.0)
    assert told[2] == pytest.approx(0.06)
    assert left[2, 2] == pytest.approx(0.001**2)


@pytest.mark.parametrize(("tolerance_rad_s", "stays"), [(0.003, True), (0.001, False)])
def test_a_belief_within_the_tolerance_of_a_reading_stays(tolerance_rad_s, stays):
    mean, covariance = np.array([1.0, 2.0, 0.004]), np.diag([1.0, 1.0, 0.002**2])
    read = BiasReading(0.002, 0.001**2, tolerance_rad_s)
    told, left = with_reading(mean, covariance, read, independent=1.0)
    assert (told[2] == mean[2]) == stays
    assert (left[2, 2] == covariance[2, 2]) == stays


def test_headings_and_stands_are_read_and_a_stand_comes_first():
    """Two windows of headings; the robot stands until the end of the second."""
    treads = np.full((SIZE, 2), 0.5)
    treads[500:750] = 0.0
    noise = 0.01 * np.random.default_rng(2).normal(size=SIZE)
    omega = np.where(np.abs(treads).max(axis=1) > 0, 0.5, 0.02) + noise
    check = HeadingCheck(
        np.array([5.0, 15.0]), *np.array([[0.03] * 2, [0.001] * 2, [1.0] * 2]), np.full(2, 0.01)
    )
    measured = np.column_stack([np.full(SIZE, np.nan), omega])
    labels = np.full(SIZE, "ice", dtype=object)
    found = bias_readings(Signals(STAMPS_S, treads, measured, labels, heading_check=check))
    assert sorted(found) == [250, 750]
    assert found[250] == BiasReading(0.03, 1e-6, BIAS_SIGMA_RAD_S)
    assert found[750].tolerance_rad_s == 0.0
    assert found[750].bias_rad_s == pytest.approx(0.02, abs=0.003)


def test_a_bias_that_only_a_mode_asks_for_is_open():
    """Until it is read, and again where it leaves what was read."""
    biases = np.array([0.0, BEYOND_RAD_S, BEYOND_RAD_S, BEYOND_RAD_S, 2.1 * BEYOND_RAD_S])
    readings = {3: BiasReading(BEYOND_RAD_S, 1e-8)}
    np.testing.assert_array_equal(bias_is_open(biases, readings), [False, True, True, False, True])
    assert not bias_is_open(biases[[0, 0, 0, 3]], readings).any()
