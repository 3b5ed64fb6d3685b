"""Systems of three linear equations, for many samples at once. Samples (N) come last."""

import numpy as np

from odometry.arrays import FloatArray

Vector = FloatArray | tuple[FloatArray, FloatArray, FloatArray]


def solve_3x3(matrix: FloatArray, right: FloatArray) -> FloatArray:
    """Solutions (3, ..., N) of matrix (3, 3, N) times solution = right (3, ..., N).

    By Cramer's rule; zero where the matrix is singular.
    """
    first, second, third = matrix[:, 0], matrix[:, 1], matrix[:, 2]
    normals = (_cross(second, third), _cross(third, first), _cross(first, second))
    determinant = dot(first, normals[0])
    is_regular = determinant != 0
    solution = np.zeros(right.shape)
    for row, normal in zip(solution, normals, strict=True):
        np.divide(dot(right, normal), determinant, out=row, where=is_regular)
    return solution


def dot(a: Vector, b: Vector) -> FloatArray:
    """Products (..., N) of vectors (3, ..., N) and (3, N)."""
    return np.asarray(a[0] * b[0] + a[1] * b[1] + a[2] * b[2])


def _cross(a: Vector, b: Vector) -> Vector:
    return a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]
