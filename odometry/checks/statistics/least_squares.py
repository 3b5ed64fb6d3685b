"""Least squares of a few columns by their products, where these are far from dependent."""

import numpy as np

from odometry.arrays import FloatArray, IntArray

# Columns whose angle has a smaller sine, whose lengths are further apart, or of whose squares two
# multiplied vanish or overflow, are left to a decomposition, which takes many times as long. Of the
# rest the normal equations give twelve digits.
LEAST_SINE, LEAST_LENGTH = 1e-2, 1e-4
SQUARES = (1e-140, 1e100)

ORDINARY, ROUNDS = 0.9, 3  # share of the rows that are fitted, those that are explained best


class Columns:
    """Columns (P, K), and the inverse of their products, which is computed once."""

    def __init__(self, values: FloatArray) -> None:
        self.values = values
        self._inverse = _inverse_of((values @ values.T).tolist())

    @property
    def independent(self) -> bool:
        """Whether none of them follows from the others."""
        known = self._inverse is not None
        return known or bool(np.linalg.matrix_rank(self.values.T) == len(self.values))

    def coefficients(self, target: FloatArray) -> FloatArray:
        """Those (P,) by which least is left of a target (K,)."""
        if self._inverse is None:
            found = np.linalg.lstsq(self.values.T, target, rcond=None)[0]
            return np.asarray(found, dtype=np.float64)
        return np.asarray(self._inverse @ (self.values @ target))

    def variances(self) -> FloatArray:
        """Variances (P,) of the coefficients, where those of a target are one."""
        if self._inverse is None:
            return np.diag(np.linalg.pinv(self.values @ self.values.T))
        return np.diag(self._inverse)


def least_squares(columns: FloatArray, target: FloatArray) -> FloatArray:
    """The coefficients (P,) of columns (P, K) by which least is left of a target (K,)."""
    return Columns(columns).coefficients(target)


def ordinary_fit(columns: FloatArray, target: FloatArray) -> tuple[float, FloatArray]:
    """Squares that columns (P, K) leave of a target (K,), and coefficients (P,), without outliers.

    Those rows are fitted and counted that the columns explain best.
    """
    count = int(ORDINARY * len(target))
    kept: IntArray = np.arange(len(target))
    for _ in range(ROUNDS):
        found = least_squares(columns[:, kept], target[kept])
        squares = (target - found @ columns) ** 2
        kept = np.argpartition(squares, count - 1)[:count]
    return float(np.sum(squares[kept])), found


def of_products(products: FloatArray) -> FloatArray | None:
    """The same coefficients (P,) by the products (P + 1, P + 1) of columns and target, the last.

    None where they would not be exact.
    """
    inverse = _inverse_of(products[:-1, :-1].tolist())
    return None if inverse is None else np.asarray(inverse @ products[:-1, -1])


def _inverse_of(products: list[list[float]]) -> FloatArray | None:
    """The inverse (P, P) of products (P, P); None where it would not be exact."""
    squares = [products[place][place] for place in range(len(products))]
    if not SQUARES[0] < min(squares) <= max(squares) < SQUARES[1]:
        return None
    if len(squares) == 1:
        return np.array([[1 / squares[0]]])
    if min(squares) < LEAST_LENGTH**2 * max(squares):
        return None
    if len(squares) == 2:
        (first, both), (_, second) = products
        over = first * second - both**2
        if over < LEAST_SINE**2 * first * second:
            return None
        return np.array([[second / over, -both / over], [-both / over, first / over]])
    lengths = np.sqrt(squares)
    lengths = lengths[:, None] * lengths
    cosines = products / lengths
    inverse = _unless_singular(cosines)
    # the greatest eigenvalue of an inverse is less than their sum, which takes a tenth of the time
    if inverse is not None and not 0 < inverse.trace() < 1 / LEAST_SINE**2:
        inverse = None if np.linalg.eigvalsh(cosines)[0] < LEAST_SINE**2 else inverse
    return None if inverse is None else np.asarray(inverse / lengths)


def _unless_singular(matrix: FloatArray) -> FloatArray | None:
    try:
        return np.asarray(np.linalg.inv(matrix))
    except np.linalg.LinAlgError:
        return None
