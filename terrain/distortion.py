"""Lens distortion of OpenCV's pinhole model, kept to the range in which it can be undone.

The polynomials of the model turn back on themselves far from the axis, so that points well
outside the field of view would land in the image. Beyond the turning point the answer is NaN.
"""

import cv2
import numpy as np

from odometry.arrays import FloatArray

COEFFICIENT_COUNTS = (0, 4, 5, 8, 12, 14)
"""Lengths of (k1, k2, p1, p2[, k3[, k4, k5, k6[, s1, s2, s3, s4[, tau_x, tau_y]]]])."""

_NEWTON_STEPS = 20
_TOLERANCE = 1e-9


def radius_limit(distortion: FloatArray) -> float:
    """Radius up to which the radial part of the model is strictly increasing.

    Parameters
    ----------
    distortion : (n,) array
        Coefficients in OpenCV's order.

    Returns
    -------
    float
        The limit in normalised image coordinates (tangent of the angle off the axis);
        infinite if the model never turns back.
    """
    k1, k2, _, _, k3, k4, k5, k6 = np.pad(distortion, (0, 14 - len(distortion)))[:8]
    numerator = np.polynomial.Polynomial([1.0, k1, k2, k3])
    denominator = np.polynomial.Polynomial([1.0, k4, k5, k6])
    square = np.polynomial.Polynomial([0.0, 1.0])  # s = r^2
    # d/dr of r N(s) / D(s), times D(s)^2
    slope = (numerator + 2 * square * numerator.deriv()) * denominator
    slope -= 2 * square * numerator * denominator.deriv()
    # both are 1 at s = 0: solved for 1/s their leading coefficient cannot vanish
    inverse_squares = np.concatenate([np.roots(slope.coef), np.roots(denominator.coef)])
    positive = inverse_squares.real[
        (np.abs(inverse_squares.imag) < 1e-9) & (inverse_squares.real > 0)
    ]
    return float(1 / np.sqrt(positive.max())) if positive.size else float("inf")


def distort(points: FloatArray, distortion: FloatArray) -> FloatArray:
    """Apply the lens to normalised image coordinates.

    Parameters
    ----------
    points : (N, 2) array
        Undistorted (x/z, y/z) in the optical frame.
    distortion : (n,) array
        Coefficients in OpenCV's order.

    Returns
    -------
    (N, 2) array
        Distorted coordinates, NaN beyond `radius_limit` and where the input is NaN.
    """
    image, jacobian = _distort(points, distortion, radius_limit(distortion))
    return _without_folds(image, jacobian)


def undistort(points: FloatArray, distortion: FloatArray) -> FloatArray:
    """Undo the lens by Newton's method; the inverse of `distort`.

    Parameters
    ----------
    points : (N, 2) array
        Distorted normalised image coordinates.
    distortion : (n,) array
        Coefficients in OpenCV's order.

    Returns
    -------
    (N, 2) array
        Undistorted coordinates, NaN where no point within `radius_limit` maps to the input.
    """
    target = np.asarray(points, dtype=np.float64)
    if not np.any(distortion):
        return target.copy()
    limit = radius_limit(distortion)
    solution = _shrink(target, limit)
    for _ in range(_NEWTON_STEPS):
        image, jacobian = _distort(solution, distortion, limit)
        error = target - image
        residual = np.hypot(error[:, 0], error[:, 1])
        if not np.nanmax(residual, initial=0.0) > _TOLERANCE / 100:
            break
        solution = _shrink(solution + _solve_2x2(jacobian, error), limit)
    solution[~(residual < _TOLERANCE)] = np.nan
    return _without_folds(solution, jacobian)


def _distort(
    points: FloatArray, distortion: FloatArray, limit: float
) -> tuple[FloatArray, FloatArray]:
    """Distorted points and their 2x2 derivatives by the undistorted ones."""
    points = np.asarray(points, dtype=np.float64)
    radius = np.hypot(points[:, 0], points[:, 1])
    valid = radius <= limit  # False for NaN
    image = np.full_like(points, np.nan)
    jacobian = np.full((len(points), 2, 2), np.nan)
    if valid.any():
        rays = np.column_stack([points[valid], np.ones(valid.sum())])
        projected, derivative = cv2.projectPoints(
            rays, np.zeros(3), np.zeros(3), np.eye(3), distortion if len(distortion) else None
        )
        image[valid] = projected.reshape(-1, 2)
        # columns 3 and 4 are the derivatives by t_x and t_y, which at depth 1 are those by x and y
        jacobian[valid] = derivative[:, 3:5].reshape(-1, 2, 2)
    return image, jacobian


def _without_folds(points: FloatArray, jacobian: FloatArray) -> FloatArray:
    """NaN where the lens mirrors its surroundings, as past a fold of the tangential part."""
    unfolded = _determinants(jacobian) > 0
    return np.where(unfolded[:, None], points, np.nan)


def _shrink(points: FloatArray, limit: float) -> FloatArray:
    """Pull points that left the valid disc back inside it."""
    radius = np.hypot(points[:, 0], points[:, 1])
    factor = np.minimum(1.0, 0.999 * limit / np.maximum(radius, 1e-300))
    return np.asarray(points * np.where(radius > limit, factor, 1.0)[:, None])


def _solve_2x2(matrices: FloatArray, vectors: FloatArray) -> FloatArray:
    """Solve many 2x2 systems by Cramer's rule; a singular one gives NaN."""
    (a, b), (c, d) = matrices[:, 0].T, matrices[:, 1].T
    determinant = _determinants(matrices)
    determinant = np.where(determinant == 0, np.nan, determinant)
    x = (d * vectors[:, 0] - b * vectors[:, 1]) / determinant
    y = (a * vectors[:, 1] - c * vectors[:, 0]) / determinant
    return np.column_stack([x, y])


def _determinants(matrices: FloatArray) -> FloatArray:
    """Return the determinants (N,) of matrices (N, 2, 2); silent about NaN, unlike NumPy."""
    return np.asarray(matrices[:, 0, 0] * matrices[:, 1, 1] - matrices[:, 0, 1] * matrices[:, 1, 0])
