"""Systems of three equations, beside NumPy's."""

import numpy as np

from odometry.models.three_equations import solve_3x3


def test_solutions_are_those_of_numpy(rng):
    matrix, right = rng.normal(size=(3, 3, 20)), rng.normal(size=(3, 4, 20))
    found = solve_3x3(matrix, right)
    for sample in range(20):
        expected = np.linalg.solve(matrix[..., sample], right[..., sample])
        np.testing.assert_allclose(found[..., sample], expected)


def test_a_singular_matrix_has_the_solution_zero():
    matrix = np.stack([np.ones((3, 3)), 2 * np.eye(3)], axis=-1)
    np.testing.assert_array_equal(solve_3x3(matrix, np.ones((3, 2))).T, [[0] * 3, [0.5] * 3])
