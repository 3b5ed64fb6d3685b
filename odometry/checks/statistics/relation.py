"""Robust linear relations between two measurements of the same motion."""

from dataclasses import dataclass

import numpy as np

from odometry.arrays import BoolArray, FloatArray, median
from odometry.checks.statistics.least_squares import Columns, least_squares, of_products
from odometry.windows.recorded.in_motion import moving_windows

ROUNDS = 8
CUTOFF = 3.0  # standard deviations, estimated by the median, beyond which a window is left out
LEAST_WINDOWS = 8  # below, nothing is said
# Treads differ from what they read by a few parts in a hundred (rounding, play, slip of a moment).
# Where columns are this near to multiples of each other, that alone decides their shares, unless
# what they differ by explains the target.
LEAST_ANGLE_RAD = 0.05
EXPLAINS = 0.5  # share of the residuals that is left when what they differ by is used
PIECES = 4


@dataclass(frozen=True)
class Relation:
    """`target = columns @ coefficients`, by least squares trimmed of outliers.

    Attributes
    ----------
    coefficients, sigmas : (P,)
    correlation : float
        Of target and fit, over the windows kept.
    kept : (K,)
        Windows that are no outliers; False also where something was not measured.
    measured : int
        Windows in which everything was measured.
    residuals : (K,)
        NaN where not measured.
    explained : float
        Share of the squares of the target that the fit explains, outliers included.
    distinct : bool
        Whether the data determine the shares of the columns: else no coefficient is certain.
    """

    coefficients: FloatArray
    sigmas: FloatArray
    correlation: float
    kept: BoolArray
    measured: int
    residuals: FloatArray
    explained: float
    distinct: bool

    @property
    def slope(self) -> float:
        """The first coefficient."""
        return float(self.coefficients[0])

    @property
    def slope_sigma(self) -> float:
        """Its standard deviation."""
        return float(self.sigmas[0])

    def certain(self, place: int = 0, times: float = 5.0) -> bool:
        """Whether a coefficient differs from zero by so many standard deviations."""
        apart = abs(self.coefficients[place]) > times * self.sigmas[place]
        return bool(self.distinct and apart)


def relation(target: FloatArray, *columns: FloatArray) -> Relation | None:
    """Fit `target` (K,) by columns (K,) each; None where too little was measured or moves.

    Outliers are left out by their distance from the fit in units of 1.4826 times the median of
    absolute residuals (least trimmed squares by repeated weighting, Rousseeuw and Leroy 1987).
    That median, the deviations and the correlation are those of windows in which a column says
    something: however long the robot stands beside them.
    """
    rows = np.array(columns)
    measured = np.isfinite(target) & np.isfinite(rows).all(axis=0)
    known, of_known = rows[:, measured], target[measured]
    if len(of_known) < LEAST_WINDOWS or not (fitted := Columns(known)).independent:
        return None
    coefficients, kept = _least_absolute(fitted, of_known), np.ones(len(of_known), dtype=np.bool_)
    moves = moving_windows(known)
    for done in range(ROUNDS):
        sizes = np.abs(of_known - coefficients @ known)
        now = sizes <= CUTOFF * 1.4826 * median(sizes[moves]) + 1e-12
        changed = bool((now != kept).any())
        if changed and now.sum() >= LEAST_WINDOWS and (few := Columns(known[:, now])).independent:
            fitted, kept = few, now
        elif done:
            break
        coefficients = fitted.coefficients(of_known[kept])
    left, of_fitted = of_known - coefficients @ known, of_known[kept]
    driven = kept & moves
    variance = np.sum(left[driven] ** 2) / max(int(driven.sum()) - len(columns), 1)
    all_kept = measured.copy()
    all_kept[measured] = kept
    return Relation(
        coefficients,
        np.sqrt(np.maximum(variance * fitted.variances(), 0.0)),
        _correlation(of_known[driven], coefficients @ known[:, driven]),
        all_kept,
        len(of_known),
        target - coefficients @ rows,
        1 - float(left @ left) / max(float(of_known @ of_known), 1e-300),
        _distinct(fitted.values, of_fitted),
    )


def pieces(target: FloatArray, *columns: FloatArray) -> list[Relation]:
    """The relation of columns (K,) to a target (K,) in each quarter of windows that suffices."""
    known = np.flatnonzero(np.isfinite(target) & np.isfinite(np.stack(columns)).all(axis=0))
    found = (
        relation(target[rows], *(column[rows] for column in columns))
        for rows in np.array_split(known, PIECES)
    )
    return [piece for piece in found if piece is not None]


def _distinct(columns: FloatArray, target: FloatArray) -> bool:
    """Whether the weakest direction of the scaled columns is wide, or explains the target.

    Scaled singular values: Belsley, Kuh and Welsch 1980, chapter 3.
    """
    lengths = np.sqrt(np.einsum("ij,ij->i", columns, columns))
    if len(columns) == 1 or not (lengths > 0).all():
        return bool((lengths > 0).all())
    scaled = columns / lengths[:, None]
    squares = np.linalg.eigvalsh(scaled @ scaled.T)  # of the singular values, the least first
    if squares[0] > LEAST_ANGLE_RAD**2 * squares[-1]:
        return True
    directions, _, _ = np.linalg.svd(scaled.T, full_matrices=False)
    parts = directions.T @ target
    left = max(float(np.sum(target**2) - np.sum(parts**2)), 0.0)
    return left < EXPLAINS * (left + float(parts[-1] ** 2))


def _least_absolute(start: Columns, target: FloatArray) -> FloatArray:
    """A start that a third of outliers does not move: least absolute residuals, by weights."""
    columns = start.values
    both = np.vstack([columns, target])
    coefficients = start.coefficients(target)
    for _ in range(ROUNDS):
        away = np.abs(target - coefficients @ columns)
        weights = 1 / np.maximum(away, 1e-3 * away.sum() / len(away) + 1e-12)
        found = of_products((both * weights) @ both.T)
        if found is None:
            root = np.sqrt(weights)
            found = least_squares(columns * root, target * root)
        coefficients = found
    return coefficients


def _correlation(a: FloatArray, b: FloatArray) -> float:
    """Correlation about zero: the motion of a robot has a natural zero."""
    size = float(np.sqrt((a @ a) * (b @ b)))
    return float(a @ b / size) if size > 0 else 0.0
