"""Chi-squared of windows by a fit to the others."""

from collections.abc import Sequence

import numpy as np

from odometry.arrays import FloatArray, IntArray
from odometry.gap.fit.hypothesis import RIDGE, Hypothesis
from odometry.gap.prepare.measured import Measured
from odometry.gap.solve import Solved

DAMPINGS = (1e-6, 1e-3, 1e-1, 1.0, 10.0)
ROUNDING = 1e-9


def held_out(hypothesis: Hypothesis, solved: Solved) -> FloatArray:
    """Chi-squared (K,) of each fold by the others' fit: one Newton step from the fit to all."""
    measured = hypothesis.measured
    fold_of_row = measured.folds[measured.window_of_row]
    judged = np.zeros(len(measured.folds))
    folds = np.unique(measured.folds)
    left = [np.flatnonzero(fold_of_row == fold) for fold in folds]
    for fold, rows in zip(folds, _without_each(hypothesis, solved, left), strict=True):
        inside = measured.folds == fold
        judged[inside] = measured.by_window(rows[: len(fold_of_row)])[inside]
    return judged


def _without_each(
    hypothesis: Hypothesis, solved: Solved, left: Sequence[IntArray]
) -> list[FloatArray]:
    """All rows by fits without some of them each: damped steps that make the others fit."""
    normal = solved.jacobian.T @ solved.jacobian
    found = [solved.rows] * len(left)
    open_ = list(range(len(left)))
    for damping in DAMPINGS:
        values = [_stepped(hypothesis, solved, normal, left[place], damping) for place in open_]
        tried = dict(zip(open_, hypothesis.rows_of_each(values), strict=True))
        fits = [place for place in open_ if _others_fit(solved, tried[place], left[place])]
        for place in fits:
            found[place] = tried[place]
        open_ = [place for place in open_ if place not in fits]
        if not open_:
            break
    return found


def _stepped(
    hypothesis: Hypothesis, solved: Solved, of_all: FloatArray, out: IntArray, damping: float
) -> FloatArray:
    """Values (V,) after a step without the rows `out`; the normal matrix (V, V) is of all rows."""
    own, own_rows = solved.jacobian.T[:, out], solved.rows[out]
    normal, gradient = of_all - own @ own.T, own @ own_rows
    damped = normal + damping * np.diag(np.diag(normal)) + RIDGE * np.eye(len(normal))
    return np.clip(solved.values + np.linalg.solve(damped, gradient), *hypothesis.bounds)


def _others_fit(solved: Solved, rows: FloatArray, out: IntArray) -> bool:
    """Whether all rows but some cost no more than before."""
    cost = solved.cost - float(solved.rows[out] @ solved.rows[out])
    others = float(rows @ rows - rows[out] @ rows[out])
    return others <= cost + ROUNDING * max(1.0, cost)


def left_out_loss(jacobian: FloatArray, rows: FloatArray, measured: Measured) -> float:
    """Chi-squared of all folds by linear least squares on the others.

    Rows (R,) and their Jacobian (R, P); those beyond the windows' belong to every fit.
    """
    fold_of_row = measured.folds[measured.window_of_row]
    columns, count = jacobian.T, len(fold_of_row)
    parts = [np.flatnonzero(fold_of_row == fold) for fold in np.unique(fold_of_row)]
    own = [_normal(columns[:, part], rows[part]) for part in parts]
    known = _normal(columns[:, count:], rows[count:])
    normal, gradient = (sum(of, at) for of, at in zip(zip(*own, strict=True), known, strict=True))
    normal = normal + RIDGE * np.trace(normal) * np.eye(len(normal))
    loss = 0.0
    for part, (own_normal, own_gradient) in zip(parts, own, strict=True):
        step = np.linalg.solve(normal - own_normal, own_gradient - gradient)
        left = rows[part] @ rows[part] + step @ (2 * own_gradient + own_normal @ step)
        loss += float(left)
    return loss


def _normal(columns: FloatArray, rows: FloatArray) -> tuple[FloatArray, FloatArray]:
    """Normal matrix (P, P) and gradient (P,) of columns (P, R) and rows (R,)."""
    return columns @ columns.T, columns @ rows
