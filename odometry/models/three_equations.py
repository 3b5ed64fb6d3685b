"""Systems of three linear equations, for many samples at once. Samples (N) come last."""

import numpy as np

from odometry.arrays import FloatArray


def solve_3x3(matrix: FloatArray, right: FloatArray) -> FloatArray:
    """Solutions (3, ..., N) of matrix (3, 3, N) times solution = right (3, ..., N).

    By Cramer's rule; zero where the matrix is singular.
    """
    first, second, third = np.moveaxis(matrix, 1, 0)
    normals = [_cross(second, third), _cross(third, first), _cross(first, second)]
    determinant = dot(first, normals[0])
    numerators: FloatArray = np.array([dot(right, normal) for normal in normals])
    solution = np.zeros_like(numerators)
    return np.divide(numerators, determinant, out=solution, where=determinant != 0)


def dot(a: FloatArray, b: FloatArray) -> FloatArray:
    """Products (..., N) of vectors (3, ..., N) and (3, N)."""
    return np.asarray(a[0] * b[0] + a[1] * b[1] + a[2] * b[2])


def _cross(a: FloatArray, b: FloatArray) -> FloatArray:
    return np.array(
        [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]]
    )
