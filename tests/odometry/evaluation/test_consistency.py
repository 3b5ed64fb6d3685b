"""NEES and NIS against a Kalman filter written here whose noise is known."""

import numpy as np
import pytest
from scipy.stats import chi2, norm

from odometry.errors import TrajectoryError
from odometry.evaluation.open_loop_consistency import (
    chi_squared_bounds,
    consistency,
    normalised_squared_errors,
)

F = np.array([[1.0, 0.1], [0.0, 0.95]])
H = np.array([[1.0, 0.0]])
Q = np.diag([1e-4, 1e-2])
R = np.array([[0.05]])


def filtered(believed_q, believed_r, runs=100, steps=100):
    """NEES and NIS (runs, steps) of a Kalman filter that assumes these noises."""
    rng = np.random.default_rng(11)
    truth = rng.normal(size=(runs, 2))
    mean, P = np.zeros((runs, 2)), np.eye(2)
    nees, nis = np.zeros((2, runs, steps))
    for k in range(steps):
        truth = truth @ F.T + rng.normal(size=(runs, 2)) * np.sqrt(np.diag(Q))
        z = truth @ H.T + rng.normal(size=(runs, 1)) * np.sqrt(R)
        mean, P = mean @ F.T, F @ P @ F.T + believed_q
        S = H @ P @ H.T + believed_r
        K = P @ H.T / S
        innovations = z - mean @ H.T
        mean, P = mean + innovations @ K.T, P - K @ S @ K.T
        nees[:, k] = normalised_squared_errors(mean - truth, np.tile(P, (runs, 1, 1)))
        nis[:, k] = normalised_squared_errors(innovations, np.tile(S, (runs, 1, 1)))
    return consistency(nees, 2), consistency(nis, 1)


def test_a_matched_filter_is_inside():
    """Shares of 100 steps: 95 % expected, for independent steps 88 to 99 with 99.9 %."""
    nees, nis = filtered(Q, R)
    assert nees.inside >= 0.88
    assert nis.inside >= 0.88
    assert nees.mean == pytest.approx(2, rel=0.05)
    assert nis.mean_bounds[0] < nis.mean < nis.mean_bounds[1]


@pytest.mark.parametrize("factor", [0.5, 2.0])
def test_noise_wrong_by_a_factor_of_two_is_outside(factor):
    """Variances too small: the mean lies above the bounds; too large: below."""
    for result, degrees in zip(filtered(Q * factor, R * factor), (2, 1), strict=True):
        assert result.mean == pytest.approx(degrees / factor, rel=0.15)
        assert not result.mean_bounds[0] < result.mean < result.mean_bounds[1]
        assert result.inside < 0.3


def test_bounds_are_those_of_the_tables():
    """Printed tables of chi-squared, 100 degrees: 74.2 and 129.6; here of 50 runs of 2 states."""
    np.testing.assert_allclose(chi_squared_bounds(2, 50), [74.2 / 50, 129.6 / 50], atol=1e-3)
    np.testing.assert_allclose(
        chi_squared_bounds(3, 40, 0.9), chi2.ppf([0.05, 0.95], 120) / 40, rtol=1e-12
    )


def test_bounds_of_many_are_those_of_the_normal_law():
    n, degrees = 1_000_000, 3
    half = norm.ppf(0.975) * np.sqrt(2 * degrees / n)
    np.testing.assert_allclose(
        chi_squared_bounds(degrees, n), [degrees - half, degrees + half], atol=1e-5
    )


def test_yaw_is_wrapped():
    errors, covariances = np.array([[0.0, 2 * np.pi - 0.1]]), np.diag([1.0, 0.01])[None]
    assert normalised_squared_errors(errors, covariances, (1,)) == pytest.approx(1.0)
    assert normalised_squared_errors(errors, covariances) == pytest.approx(3823, rel=1e-3)
    assert errors[0, 1] == 2 * np.pi - 0.1


def test_squares_are_mahalanobis_lengths(rng):
    roots = rng.normal(size=(4, 5, 3, 3))
    covariances, errors = roots @ roots.swapaxes(-1, -2), rng.normal(size=(4, 5, 3))
    squares = normalised_squared_errors(errors, covariances)
    assert squares.shape == (4, 5)
    expected = errors[2, 3] @ np.linalg.inv(covariances[2, 3]) @ errors[2, 3]
    assert squares[2, 3] == pytest.approx(expected)


def test_missing_measurements_count_no_more_than_they_are():
    squared = np.array([[1.0, np.nan, 3.0], [2.0, np.nan, np.nan]])
    result = consistency(squared, 2)
    np.testing.assert_array_equal(result.step_means, [1.5, np.nan, 3.0])
    np.testing.assert_allclose(result.step_bounds[0], chi_squared_bounds(2, 2))
    np.testing.assert_allclose(result.step_bounds[2], chi_squared_bounds(2, 1))
    assert np.all(np.isnan(result.step_bounds[1]))
    assert result.mean == 2.0
    np.testing.assert_allclose(result.mean_bounds, chi_squared_bounds(2, 3))
    assert result.inside == 1.0


def test_half_of_the_steps_inside():
    assert consistency(np.array([[2.0, 2000.0]]), 2).inside == 0.5
    assert consistency(np.array([[2.0, 0.0]]), 2).inside == 0.5


@pytest.mark.parametrize("squared", [np.zeros(3), np.full((2, 2), np.nan)])
def test_nothing_to_average_is_refused(squared):
    with pytest.raises(TrajectoryError, match=r"expected \(runs, steps\)"):
        consistency(squared, 2)


def test_shapes_that_do_not_agree_are_refused():
    with pytest.raises(TrajectoryError, match=r"expected \(5, 3, 3\)"):
        normalised_squared_errors(np.zeros((5, 3)), np.eye(3))
