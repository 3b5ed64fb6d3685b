"""CR2 and its degrees of freedom against their printed definition with dense matrices."""

import numpy as np
import pytest
from scipy.linalg import sqrtm

from odometry.identification.spread import correlated_groups, spread_between


def test_groups_are_runs_else_stretches_of_five_windows_or_six_shorter_ones():
    runs = np.repeat(np.array(["a", "b", "c"], dtype=object), [4, 9, 30])
    assert correlated_groups(runs).tolist() == [0] * 4 + [1] * 9 + [2] * 30
    two = correlated_groups(runs[runs != "a"])
    assert np.all(np.diff(two) >= 0)
    assert np.unique(two, return_counts=True)[1].min() >= 5 - 1
    assert not set(two[:9]) & set(two[9:])
    assert len(set(two)) == 1 + 6
    few = runs[runs == "c"]
    assert np.bincount(correlated_groups(few[:29])).tolist() == [5, 4, 4, 4, 4, 4, 4]
    assert correlated_groups(few[:6]).tolist() == [0, 1, 2, 3, 4, 5]
    assert correlated_groups(few[:5]) is None


def printed(groups, design, residuals):
    """Variances by A_g = (I - H_gg)^-1/2, degrees by the matrix of all (I - H)_g' A_g X_g B c."""
    rows = np.repeat(groups, 3)
    stacked, left = design.reshape(-1, design.shape[-1]), residuals.ravel()
    bread = np.linalg.inv(stacked.T @ stacked)
    annihilator = np.eye(len(stacked)) - stacked @ bread @ stacked.T
    scores, columns = [], []
    for group in np.unique(groups):
        here = rows == group
        hat = stacked[here] @ bread @ stacked[here].T
        adjusted = np.linalg.inv(sqrtm(np.eye(len(hat)) - hat)).real @ stacked[here] @ bread
        scores.append(adjusted.T @ left[here])
        columns.append(annihilator[:, here] @ adjusted)
    grams = np.einsum("gnf,hnf->fgh", columns, columns)
    freedom = np.trace(grams, axis1=1, axis2=2) ** 2 / np.sum(grams**2, axis=(1, 2))
    return np.sum(np.square(scores), axis=0), freedom


@pytest.fixture
def regression():
    rng = np.random.default_rng(3)
    groups = np.array([0] * 6 + [1] * 9 + [2] * 4 + [3] * 12)
    design = rng.standard_normal((len(groups), 3, 4)) * [1, 0.3, 2, 0.1]
    stacked = design.reshape(-1, 4)
    noise = rng.standard_normal(len(stacked))
    residuals = noise - stacked @ np.linalg.lstsq(stacked, noise, rcond=None)[0]
    return groups, design, residuals.reshape(-1, 3)


def test_variances_and_degrees_are_the_printed_ones(regression):
    variances, freedom = spread_between(*regression)
    expected, degrees = printed(*regression)
    np.testing.assert_allclose(variances, expected, rtol=1e-9)
    np.testing.assert_allclose(freedom, degrees, rtol=1e-9)
    assert np.all(freedom < 3.0 + 1e-9)


def test_the_mean_of_equal_groups_has_students_own_degrees():
    """One parameter, groups of one size: the variance of group means, and G - 1 degrees."""
    rng = np.random.default_rng(4)
    groups = np.repeat(np.arange(6), 5)
    values = rng.standard_normal((30, 3)) + rng.standard_normal(6)[groups][:, None]
    residuals = values - values.mean()
    variances, freedom = spread_between(groups, np.ones((30, 3, 1)), residuals)
    means = values.reshape(6, -1).mean(axis=1)
    assert variances == pytest.approx(means.var(ddof=1) / 6, rel=1e-9)
    assert freedom == pytest.approx(5.0, rel=1e-9)


def test_a_direction_without_data_and_one_that_a_single_group_determines(regression):
    """Neither makes numbers that are not finite; the variances of the others stay as it is."""
    groups, design, residuals = regression
    alone = np.where((groups == 2)[:, None, None], 1.0, 0.0) * np.ones((1, 3, 1))
    wide = np.concatenate([design, np.zeros_like(design[..., :1]), alone], axis=-1)
    stacked = wide.reshape(-1, 6)
    left = residuals.ravel()
    left = left - stacked @ np.linalg.lstsq(stacked, left, rcond=None)[0]
    with np.errstate(all="raise"):
        variances, _ = spread_between(groups, wide[..., [0, 1, 2, 3, 5]], left.reshape(-1, 3))
        empty, _ = spread_between(groups, wide[..., :5], residuals)
    assert np.all(np.isfinite(variances))
    np.testing.assert_allclose(empty[:4], spread_between(*regression)[0], rtol=1e-6)
