"""The search for few parameters, beside closed forms and another program."""

import numpy as np
import pytest
from scipy.optimize import lsq_linear

from odometry.gap.solve import LEAST_GAIN, differences, least_squares, with_jacobian

FREE = (np.full(4, -np.inf), np.full(4, np.inf))
SCALES = np.array([0.1, 1.0, 10.0, 1.0])


@pytest.fixture
def linear(rng):
    """A design (200, 4), a target (200,), and their residuals as a function."""
    design, target = rng.normal(size=(200, 4)), 30.0 * rng.normal(size=200)
    return design, target, lambda values: design @ values - target


def test_linear_residuals_end_at_the_normal_equations(linear):
    design, target, rows_at = linear
    expected = np.linalg.solve(design.T @ design, design.T @ target)
    found = least_squares(rows_at, np.full(4, 50.0), SCALES, FREE, 20)
    np.testing.assert_allclose(found.values, expected, atol=1e-6)
    np.testing.assert_array_equal(found.rows, rows_at(found.values))
    assert found.cost == pytest.approx(((design @ expected - target) ** 2).sum())


@pytest.mark.parametrize("seed", range(5))
def test_within_bounds_it_is_the_bounded_optimum(linear, seed):
    """Of columns that nearly stand in for each other, so that a bound moves the others."""
    design, target, _ = linear
    design = design @ (np.eye(4) + 20.0 * np.ones((4, 4)))
    target = 20.0 * target

    def rows_at(values):
        return design @ values - target

    rng = np.random.default_rng(seed)
    inside = np.linalg.lstsq(design, target)[0]
    low = inside + rng.uniform(-4.0, 2.0, 4)
    high = low + rng.uniform(0.5, 3.0, 4)
    expected = lsq_linear(design, target, (low, high), tol=1e-12)
    found = least_squares(rows_at, rng.uniform(low, high), SCALES, (low, high), 40)
    assert ((found.values >= low) & (found.values <= high)).all()
    assert found.cost - 2 * expected.cost <= LEAST_GAIN * max(1.0, 2e-3 * expected.cost)
    np.testing.assert_array_equal(found.values == low, expected.active_mask == -1)
    np.testing.assert_array_equal(found.values == high, expected.active_mask == 1)


def test_what_is_pinned_stays_and_the_others_fit_beside_it(linear):
    design, target, rows_at = linear
    bounds = (FREE[0].copy(), FREE[1].copy())
    bounds[0][1] = bounds[1][1] = 7.0
    found = with_jacobian(
        rows_at, least_squares(rows_at, np.zeros(4), SCALES, bounds, 20), SCALES, bounds
    )
    others = [0, 2, 3]
    expected = np.linalg.lstsq(design[:, others], target - 7.0 * design[:, 1])[0]
    assert found.values[1] == 7.0
    np.testing.assert_allclose(found.values[others], expected, atol=1e-6)
    np.testing.assert_allclose(found.jacobian[:, others], design[:, others], atol=1e-6)
    np.testing.assert_array_equal(found.jacobian[:, 1], 0.0)


def test_what_is_pinned_is_never_moved():
    def rows_at(values):
        assert values[1] == 7.0
        return np.array([values[0] ** 2, values[1]])

    values, scales = np.array([2.0, 7.0]), np.full(2, 1e-4)
    bounds = (np.array([0.0, 7.0]), np.array([5.0, 7.0]))
    found = differences(rows_at, values, rows_at(values), scales, bounds)
    np.testing.assert_allclose(found, [[4.0, 0.0], [0.0, 0.0]], atol=1e-5)


def test_at_a_bound_the_derivative_is_taken_inside_and_what_is_held_has_none():
    def rows_at(values):
        assert (values <= [2.0, 5.0]).all()
        return np.array([values[0] ** 2, values[0] * values[1], np.sin(values[1])])

    bounds = (np.zeros(2), np.array([2.0, 5.0]))
    values, scales = np.array([2.0, 1.0]), np.full(2, 1e-4)
    expected = [[4.0, 0.0], [1.0, 2.0], [0.0, np.cos(1.0)]]
    found = differences(rows_at, values, rows_at(values), scales, bounds)
    np.testing.assert_allclose(found, expected, atol=1e-5)
    ended = least_squares(rows_at, values, scales, bounds, 0)
    held = with_jacobian(rows_at, ended, scales, bounds).jacobian
    np.testing.assert_allclose(held, np.array(expected) * [0.0, 1.0], atol=1e-5)


def test_a_curved_valley_is_followed_to_its_end():
    """Rosenbrock's function, times 1000 so that the last steps still gain."""

    def rows_at(values):
        return 1000.0 * np.array([10.0 * (values[1] - values[0] ** 2), 1.0 - values[0]])

    bounds = (np.full(2, -np.inf), np.full(2, np.inf))
    found = least_squares(rows_at, np.array([-1.2, 1.0]), np.full(2, 1e-4), bounds, 100)
    np.testing.assert_allclose(found.values, 1.0, atol=1e-3)


def test_steps_to_where_nothing_is_finite_are_taken_back():
    def rows_at(values):
        with np.errstate(invalid="ignore"):
            return 100.0 * np.log(values) - 100.0

    bounds = (np.array([-100.0]), np.array([100.0]))
    found = least_squares(rows_at, np.array([40.0]), np.ones(1), bounds, 50)
    assert found.values[0] == pytest.approx(np.e, rel=1e-3)
