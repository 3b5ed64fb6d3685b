"""Linear fits to all folds but one, against least squares one by one."""

from types import SimpleNamespace

import numpy as np
import pytest

from odometry.gap.fit.left_out import left_out_loss


def test_each_fold_is_judged_by_least_squares_on_the_others(rng):
    """The last two rows are of no window: every fit knows them."""
    measured = SimpleNamespace(folds=np.array([0, 1, 2, 0]), window_of_row=np.repeat(range(4), 5))
    jacobian, rows = rng.normal(size=(22, 3)), rng.normal(size=22)
    fold_of_row = np.append(measured.folds[measured.window_of_row], [-1, -1])
    expected = 0.0
    for fold in range(3):
        out = fold_of_row == fold
        step = np.linalg.lstsq(jacobian[~out], -rows[~out], rcond=None)[0]
        expected += np.sum((rows[out] + jacobian[out] @ step) ** 2)
    assert left_out_loss(jacobian, rows, measured) == pytest.approx(expected)
