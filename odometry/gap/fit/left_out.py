"""Chi-squared of windows by a fit to the others."""

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
    normal = solved.jacobian.T @ solved.jacobian
    for fold in np.unique(measured.folds):
        rows = _without(hypothesis, solved, normal, np.flatnonzero(fold_of_row == fold))
        inside = measured.folds == fold
        judged[inside] = measured.by_window(rows[: len(fold_of_row)])[inside]
    return judged


def _without(
    hypothesis: Hypothesis, solved: Solved, of_all: FloatArray, out: IntArray
) -> FloatArray:
    """All rows by a fit to those that are not `out`: a damped step that makes them fit.

    `of_all` (V, V) is the normal matrix of all rows.
    """
    own, own_rows = solved.jacobian.T[:, out], solved.rows[out]
    normal, gradient = of_all - own @ own.T, own @ own_rows
    cost = solved.cost - float(own_rows @ own_rows)
    for damping in DAMPINGS:
        damped = normal + damping * np.diag(np.diag(normal)) + RIDGE * np.eye(len(normal))
        step = np.linalg.solve(damped, gradient)
        rows = hypothesis.rows(np.clip(solved.values + step, *hypothesis.bounds))
        others = float(rows @ rows - rows[out] @ rows[out])
        if others <= cost + ROUNDING * max(1.0, cost):
            return rows
    return solved.rows


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
