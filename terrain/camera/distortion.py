"""Lens distortion of OpenCV's pinhole model, kept to the range in which it can be undone.

The polynomials of the model turn back on themselves far from the axis, so that points well
outside the field of view would land in the image. Beyond the turning point the answer is NaN.
"""

from functools import lru_cache

import numpy as np

from odometry.arrays import FloatArray

COEFFICIENT_COUNTS = (0, 4, 5, 8, 12, 14)
"""Lengths of (k1, k2, p1, p2[, k3[, k4, k5, k6[, s1, s2, s3, s4[, tau_x, tau_y]]]])."""

_NEWTON_STEPS = 20
_TOLERANCE = 1e-9
_WIDEST = 4.0  # tangent of 76 degrees
_RADII, _ANGLES = 257, 64
_FAR_FROM_A_FOLD = 0.05


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
    return _radius_limit(*_padded(distortion)[:8].tolist())


@lru_cache(maxsize=64)  # needed at each projection, of the lens of one camera
def _radius_limit(*coefficients: float) -> float:
    k1, k2, _, _, k3, k4, k5, k6 = coefficients
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
    points = np.asarray(points, dtype=np.float64)
    coefficients, limit, unfolded = _known(*distortion.tolist())
    square = points[:, 0] ** 2 + points[:, 1] ** 2
    within = np.where((square <= limit * limit)[:, None], points, np.nan)
    image = _tilt(_lens(within, coefficients[:12]), coefficients[12:])
    doubtful = square > unfolded**2
    if doubtful.any():
        jacobian = _derivatives(within[doubtful], coefficients)
        image[doubtful] = _without_folds(image[doubtful], jacobian)
    return image


@lru_cache(maxsize=64)
def _known(*distortion: float) -> tuple[FloatArray, float, float]:
    """All 14 coefficients, `radius_limit` and `_unfolded_radius`."""
    coefficients = _padded(np.array(distortion))
    return coefficients, radius_limit(coefficients), _unfolded_radius(*coefficients.tolist())


def _unfolded_radius(*coefficients: float) -> float:
    """Radius up to which the lens is far from any fold, so that no derivative has to be checked.

    Between the tested radii the determinant changes by much less than its limit;
    it is 1 on the axis.
    """
    lens = np.array(coefficients)
    radii = np.linspace(0.0, min(radius_limit(lens), _WIDEST), _RADII)
    angles = np.linspace(0.0, 2 * np.pi, _ANGLES, endpoint=False)
    places = radii[:, None, None] * np.stack([np.cos(angles), np.sin(angles)], axis=-1)
    determinants = _determinants(_derivatives(places.reshape(-1, 2), lens))
    folded = ~(determinants.reshape(_RADII, _ANGLES) > _FAR_FROM_A_FOLD).all(axis=1)
    return float(radii[max(int(folded.argmax()) - 1, 0)] if folded.any() else radii[-1])


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
    within = np.where((radius <= limit)[:, None], points, np.nan)  # NaN beyond, and for NaN
    coefficients = _padded(distortion)
    image = _tilt(_lens(within, coefficients[:12]), coefficients[12:])
    return image, _derivatives(within, coefficients)


def _padded(distortion: FloatArray) -> FloatArray:
    """All 14 coefficients."""
    coefficients = np.zeros(14)
    coefficients[: len(distortion)] = distortion
    return coefficients


def _lens(points: FloatArray, coefficients: FloatArray) -> FloatArray:
    """Apply the radial, tangential and thin prism terms."""
    k1, k2, p1, p2, k3, k4, k5, k6, s1, s2, s3, s4 = coefficients.tolist()
    x, y = np.ascontiguousarray(points.T)
    square = x * x + y * y
    radial = 1 + square * (k1 + square * (k2 + square * k3))
    if k4 or k5 or k6:
        radial /= 1 + square * (k4 + square * (k5 + square * k6))
    seen = np.empty_like(points)
    seen[:, 0] = x * radial + 2 * p1 * x * y + p2 * (square + 2 * x * x)
    seen[:, 1] = y * radial + p1 * (square + 2 * y * y) + 2 * p2 * x * y
    if s1 or s2 or s3 or s4:
        seen[:, 0] += square * (s1 + s2 * square)
        seen[:, 1] += square * (s3 + s4 * square)
    return seen


def _derivatives(points: FloatArray, coefficients: FloatArray) -> FloatArray:
    """Derivatives (N, 2, 2) of the distorted points by the undistorted ones."""
    k1, k2, p1, p2, k3, k4, k5, k6, s1, s2, s3, s4, _, _ = coefficients
    x, y = points.T
    square = x * x + y * y
    numerator = 1 + square * (k1 + square * (k2 + square * k3))
    denominator = 1 + square * (k4 + square * (k5 + square * k6))
    radial = numerator / denominator
    slope = k1 + square * (2 * k2 + 3 * square * k3)
    slope = (slope - radial * (k4 + square * (2 * k5 + 3 * square * k6))) / denominator
    prism_x, prism_y = 2 * (s1 + 2 * s2 * square), 2 * (s3 + 2 * s4 * square)
    mixed = 2 * (x * y * slope + p1 * x + p2 * y)
    jacobian = np.empty((len(points), 2, 2))
    jacobian[:, 0, 0] = radial + 2 * x * x * slope + 2 * p1 * y + 6 * p2 * x + prism_x * x
    jacobian[:, 0, 1] = mixed + prism_x * y
    jacobian[:, 1, 0] = mixed + prism_y * x
    jacobian[:, 1, 1] = radial + 2 * y * y * slope + 6 * p1 * y + 2 * p2 * x + prism_y * y
    if not coefficients[12:].any():
        return jacobian
    matrix = _tilt_matrix(coefficients[12:])
    projected = _lens(points, coefficients[:12]) @ matrix[:, :2].T + matrix[:, 2]
    image = projected[:, :2] / projected[:, 2:]
    by_point = (matrix[:2, :2] - image[:, :, None] * matrix[2, :2]) / projected[:, 2:, None]
    return np.asarray(by_point @ jacobian)


def _tilt(points: FloatArray, angles: FloatArray) -> FloatArray:
    """Project on a sensor that is tilted by (tau_x, tau_y), as OpenCV defines it."""
    if not angles.any():
        return points
    matrix = _tilt_matrix(angles)
    projected = points @ matrix[:, :2].T + matrix[:, 2]
    return np.asarray(projected[:, :2] / projected[:, 2:])


def _tilt_matrix(angles: FloatArray) -> FloatArray:
    (cos_x, cos_y), (sin_x, sin_y) = np.cos(angles), np.sin(angles)
    about_x = np.array([[1, 0, 0], [0, cos_x, sin_x], [0, -sin_x, cos_x]])
    about_y = np.array([[cos_y, 0, -sin_y], [0, 1, 0], [sin_y, 0, cos_y]])
    rotation = about_y @ about_x
    corner = rotation[2, 2]
    projection = np.array([[corner, 0, -rotation[0, 2]], [0, corner, -rotation[1, 2]], [0, 0, 1]])
    return np.asarray(projection @ rotation)


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
    """Return the determinants (N,) of matrices (N, 2, 2); no warning for NaN, unlike NumPy."""
    return np.asarray(matrices[:, 0, 0] * matrices[:, 1, 1] - matrices[:, 0, 1] * matrices[:, 1, 0])
