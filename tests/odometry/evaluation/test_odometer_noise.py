"""Noise that was put into an odometer is found again, and its covariance is then consistent."""

import numpy as np
import pytest

from odometry.evaluation.odometer_noise import OdometerNoise, measured_noise, motion_errors
from odometry.evaluation.open_loop_consistency import (
    consistency_by_halves,
    open_loop_consistency,
)
from odometry.evaluation.open_loop_errors import SOURCES, OpenLoopPath
from odometry.geometry import se2

STEP_M = 0.1
RANDOM = {"random_x_per_m": 0.03**2, "random_y_per_m": 0.02**2, "random_yaw_per_rad": 0.02**2}


def variances(**by_source):
    return np.array([by_source.get(name, 0.0) for name in SOURCES])


def drive(rng, length_m, constant_yaw=0.0, size=1.0):
    """A winding drive: its true poses, and the path of an odometer with random errors."""
    count = int(length_m / STEP_M)
    turn = 0.12 * np.sin(np.arange(count) / 17) * STEP_M * 5
    true = np.column_stack([np.full(count, STEP_M), np.zeros(count), turn])
    deviations = size * np.column_stack(
        [
            np.full(count, 0.03 * np.sqrt(STEP_M)),
            np.full(count, 0.02 * np.sqrt(STEP_M)),
            0.02 * np.sqrt(np.abs(turn)),
        ]
    )
    seen = true + deviations * rng.normal(size=(count, 3))
    seen[:, 2] += constant_yaw * STEP_M
    metres = STEP_M * np.arange(count + 1)
    return chain(true), OpenLoopPath(chain(seen), metres, metres)


def chain(steps):
    poses = [np.zeros(3)]
    for step in steps:
        poses.append(se2.compose(poses[-1], step))
    return np.array(poses)


def test_errors_of_motions_are_seen_from_their_start(rng):
    truth, path = drive(rng, 10)
    first, last = np.array([0, 20]), np.array([50, 90])
    moved = se2.compose(np.array([5.0, -3.0, 2.0]), path.poses)
    np.testing.assert_allclose(
        motion_errors(moved, truth, first, last),
        motion_errors(path.poses, truth, first, last),
        atol=1e-9,
    )
    assert not motion_errors(truth, truth, first, last).any()


def test_random_errors_are_found_again(rng):
    """On 1500 m, to a fifth of each deviation."""
    truth, path = drive(rng, 1500)
    rows = np.arange(len(truth))
    found = measured_noise(path, rows, truth)
    sigma = dict(zip(SOURCES, np.sqrt(found.variances), strict=True))
    assert sigma["random_x_per_m"] == pytest.approx(0.03, rel=0.2)
    assert sigma["random_y_per_m"] == pytest.approx(0.02, rel=0.3)
    assert found.longest_m == 50.0
    exact = path.covariances(variances(**RANDOM), rows[:1], rows[-1:])[0]
    ours = path.covariances(found.variances, rows[:1], rows[-1:])[0]
    assert np.sqrt(ours[2, 2] / exact[2, 2]) == pytest.approx(1.0, abs=0.4)


def test_a_drift_of_heading_is_found_as_a_constant(rng):
    truth, path = drive(rng, 600, constant_yaw=0.01)
    found = measured_noise(path, np.arange(len(truth)), truth)
    sigma = dict(zip(SOURCES, np.sqrt(found.variances), strict=True))
    assert sigma["constant_yaw_per_m"] == pytest.approx(0.01, rel=0.15)


def test_noise_of_the_poses_is_not_taken_for_the_odometers(rng):
    truth, path = drive(rng, 1000)
    seen = truth + rng.normal(size=truth.shape) * [0.05, 0.05, 0.02]
    found = measured_noise(path, np.arange(len(truth)), seen)
    np.testing.assert_allclose(np.sqrt(found.reference), [0.05, 0.02], rtol=0.25)
    sigma = dict(zip(SOURCES, np.sqrt(found.variances), strict=True))
    assert sigma["random_x_per_m"] == pytest.approx(0.03, rel=0.35)


def test_no_source_is_taken_to_be_absent(rng):
    """A drive without any error along y: its variance is small, and not 0."""
    count = 600
    true = np.tile([STEP_M, 0.0, 0.0], (count, 1))
    seen = true + rng.normal(size=(count, 3)) * [0.03 * np.sqrt(STEP_M), 0, 0]
    metres = STEP_M * np.arange(count + 1)
    found = measured_noise(
        OpenLoopPath(chain(seen), metres, metres), np.arange(count + 1), chain(true)
    )
    by = dict(zip(SOURCES, found.variances, strict=True))
    assert np.all(found.variances > 0)
    assert by["random_y_per_m"] < by["random_x_per_m"] == pytest.approx(0.03**2, rel=0.5)


def test_a_short_run_measures_nothing(rng):
    truth, path = drive(rng, 7.5)
    assert measured_noise(path, np.arange(len(truth)), truth) is None
    assert measured_noise(path, np.arange(1), truth[:1]) is None


def test_the_right_noise_is_consistent_and_a_wrong_one_is_not(rng):
    truth, path = drive(rng, 1000)
    rows = np.arange(len(truth))
    right = OdometerNoise(variances(**RANDOM), np.zeros(2), 0, 0.0)
    checks = open_loop_consistency(path, rows, truth, right)
    assert [check.distance_m for check in checks] == [5, 20, 100]
    assert [check.independent for check in checks] == [200, 50, 10]
    assert all(check.is_consistent for check in checks)
    for wrong in (0.25, 4.0):
        noise = OdometerNoise(wrong * variances(**RANDOM), np.zeros(2), 0, 0.0)
        check = open_loop_consistency(path, rows, truth, noise)[0]
        assert not check.is_consistent
        assert check.mean == pytest.approx(3 / wrong, rel=0.25)


def test_each_half_is_judged_by_the_noise_of_the_other(rng):
    """A second half with three times the error: NEES far above 3 there, far below before."""
    truth, path = drive(rng, 800)
    rows = np.arange(len(truth))
    alike = consistency_by_halves(path, rows, truth)
    assert [check.distance_m for check in alike] == [5, 20, 100]
    assert alike[0].mean == pytest.approx(3.0, rel=0.25)
    steps = se2.between(path.poses[:-1], path.poses[1:])
    true = se2.between(truth[:-1], truth[1:])
    steps[4000:] = true[4000:] + 3 * (steps[4000:] - true[4000:])
    worse = OpenLoopPath(chain(steps), path.travel_m, path.signed_m)
    uneven = consistency_by_halves(worse, rows, truth)
    assert uneven[0].mean > 9
    assert not uneven[0].is_consistent


def test_without_poses_nothing_is_checked(rng):
    _, path = drive(rng, 20)
    assert consistency_by_halves(path, np.empty(0, np.int64), np.empty((0, 3))) == []
