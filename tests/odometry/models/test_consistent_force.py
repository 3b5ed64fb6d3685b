import numpy as np
import pytest

from odometry.models.inertia_forces import consistent_force


def solve(force_at, limit):
    return consistent_force(force_at, np.asarray(limit, float))


def test_a_line_is_solved_exactly():
    """f = 3 + f / 2 at 6, f = 3 - 2 f at 1; no force stays none."""
    offset, slope = np.array([3.0, 3.0, 0.0]), np.array([0.5, -2.0, 0.5])
    force = solve(lambda f: (offset + slope * f, slope), [10.0, 10.0, 10.0])
    np.testing.assert_allclose(force, [6, 1, 0], rtol=1e-14)


def test_more_than_the_limit_is_the_limit():
    force = solve(lambda f: (20 + 0 * f, 0 * f), [10.0, 30.0])
    np.testing.assert_array_equal(force, [10, 20])


def test_feedback_of_more_than_one_to_one_ends_at_the_limit():
    force = solve(lambda f: (1 + 2 * f, 2 + 0 * f), [10.0])
    np.testing.assert_allclose(force, [10])


def test_the_smallest_of_three_is_found():
    """f = f + (f-1)(f-2)(f-3): Newton's method from no force stays below the first root."""
    force = solve(lambda f: (f - (f - 1) * (f - 2) * (f - 3), 1 - (3 * f**2 - 12 * f + 11)), [10.0])
    np.testing.assert_allclose(force, [1], rtol=1e-12)


@pytest.mark.parametrize("slope", [0.99, -1e4], ids=["too far", "too short"])
def test_newton_steps_going_astray_are_bisected(slope):
    """A step function whose slope lies: the bracket alone finds the jump at 4."""
    force = solve(lambda f: (np.where(f < 4, 9.0, 0.0), slope + 0 * f), [10.0])
    np.testing.assert_allclose(force, [4], rtol=1e-12)


def test_neighbours_do_not_matter():
    """Each sample is solved as if alone, to the last bit."""
    offset = np.linspace(0, 9, 50)
    together = solve(lambda f: (offset * np.cos(f / 9), -offset * np.sin(f / 9) / 9), [9.0] * 50)
    alone = [
        solve(lambda f, o=o: (o * np.cos(f / 9), -o * np.sin(f / 9) / 9), [9.0])[0] for o in offset
    ]
    np.testing.assert_array_equal(together, alone)
    np.testing.assert_allclose(offset * np.cos(together / 9), together, atol=1e-13)
