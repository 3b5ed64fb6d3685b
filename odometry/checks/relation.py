"""Robust linear relations between two measurements of the same motion."""

from dataclasses import dataclass

import numpy as np

from odometry.arrays import BoolArray, FloatArray

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
    """
    design = np.stack(columns, axis=-1)
    measured = np.isfinite(target) & np.isfinite(design).all(axis=1)
    if measured.sum() < LEAST_WINDOWS or np.linalg.matrix_rank(design[measured]) < len(columns):
        return None
    coefficients, kept = _least_absolute(design, target, measured), measured
    for _ in range(ROUNDS):
        residuals = target - design @ coefficients
        scale = 1.4826 * np.median(np.abs(residuals[measured]))
        before, kept = kept, measured & (np.abs(residuals) <= CUTOFF * scale + 1e-12)
        if kept.sum() < LEAST_WINDOWS or np.linalg.matrix_rank(design[kept]) < len(columns):
            kept = before
        coefficients = _least_squares(design[kept], target[kept])
        if (kept == before).all():
            break
    residuals = target - design @ coefficients
    variance = np.sum(residuals[kept] ** 2) / max(int(kept.sum()) - len(columns), 1)
    curvature = design[kept].T @ design[kept]
    sigmas = np.sqrt(np.maximum(variance * np.diag(np.linalg.pinv(curvature)), 0.0))
    return Relation(
        coefficients,
        sigmas,
        _correlation(target[kept], (design @ coefficients)[kept]),
        kept,
        int(measured.sum()),
        residuals,
        1 - float(np.sum(residuals[measured] ** 2) / max(np.sum(target[measured] ** 2), 1e-300)),
        _distinct(design[kept], target[kept]),
    )


def pieces(target: FloatArray, *columns: FloatArray) -> list[Relation]:
    """The relation of columns (K,) to a target (K,) in each quarter of windows that suffices."""
    known = np.flatnonzero(np.isfinite(target) & np.isfinite(np.stack(columns)).all(axis=0))
    found = (
        relation(target[rows], *(column[rows] for column in columns))
        for rows in np.array_split(known, PIECES)
    )
    return [piece for piece in found if piece is not None]


def _distinct(design: FloatArray, target: FloatArray) -> bool:
    """Whether the weakest direction of the scaled columns is wide, or explains the target.

    Scaled singular values: Belsley, Kuh and Welsch 1980, chapter 3.
    """
    lengths = np.linalg.norm(design, axis=0)
    if not (lengths > 0).all():
        return False
    directions, sizes, _ = np.linalg.svd(design / lengths, full_matrices=False)
    if sizes[-1] > LEAST_ANGLE_RAD * sizes[0]:
        return True
    parts = directions.T @ target
    left = max(float(np.sum(target**2) - np.sum(parts**2)), 0.0)
    return left < EXPLAINS * (left + float(parts[-1] ** 2))


def _least_squares(design: FloatArray, target: FloatArray) -> FloatArray:
    return np.asarray(np.linalg.lstsq(design, target, rcond=None)[0], dtype=np.float64)


def _least_absolute(design: FloatArray, target: FloatArray, measured: BoolArray) -> FloatArray:
    """A start that a third of outliers does not move: least absolute residuals, by weights."""
    design, target = design[measured], target[measured]
    coefficients = _least_squares(design, target)
    for _ in range(ROUNDS):
        away = np.abs(target - design @ coefficients)
        weights = 1 / np.sqrt(np.maximum(away, 1e-3 * np.mean(away) + 1e-12))
        coefficients = _least_squares(design * weights[:, None], target * weights)
    return coefficients


def _correlation(a: FloatArray, b: FloatArray) -> float:
    """Correlation about zero: the motion of a robot has a natural zero."""
    size = float(np.sqrt(np.sum(a**2) * np.sum(b**2)))
    return float(np.sum(a * b) / size) if size > 0 else 0.0
