import numpy as np
from hypothesis import given
from hypothesis import strategies as st
from scipy.spatial.distance import cdist

from odometry.feel.classifier.discriminant import (
    fitted_discriminant,
    fitted_to_means,
    moments_of,
    pooled,
)

NAMES = ("a", "b")


def made(seed, slope=0.0):
    """Windows (W, 3 + 1) of eight runs; the last column is a covariate that runs differ in."""
    rng = np.random.default_rng(seed)
    runs = np.repeat(np.arange(8), 40)
    labels = np.array(NAMES, dtype=object)[runs % 2]
    covariate = rng.normal(size=320) + runs / 4
    centre = np.where(runs % 2, 1.0, -1.0)[:, None] * np.array([1.0, 0.5, 0.0])
    columns = centre + rng.normal(size=(320, 3)) @ np.diag([1.0, 2.0, 0.5])
    columns += slope * covariate[:, None]
    return np.column_stack([columns, covariate]), labels, runs


def fitted(table, labels, runs):
    return fitted_discriminant(pooled(moments_of(table, labels, runs), NAMES), 1, 0.1)


@given(st.integers(0, 50), st.floats(-3.0, 3.0))
def test_what_a_covariate_adds_changes_no_distance(seed, slope):
    table, labels, runs = made(seed)
    other, *_ = made(seed, slope)
    plain = fitted(table, labels, runs)
    tilted = fitted(other, labels, runs)
    both = [(one.left(of) ** 2).sum(axis=2) for one, of in ((plain, table), (tilted, other))]
    np.testing.assert_allclose(both[0], both[1], rtol=0.05, atol=0.05)


def test_distances_are_those_of_mahalanobis():
    table, labels, runs = made(3)
    columns = table[:, :3]
    moments = moments_of(columns, labels, runs)
    one = fitted_discriminant(pooled(moments, NAMES), 0, 0.0)
    off, within, between = [], [], np.zeros((3, 3))
    for name in NAMES:
        means = np.stack(
            [columns[runs == r].mean(axis=0) for r in range(8) if NAMES[r % 2] == name]
        )
        off.append(means.mean(axis=0))
        between += (means - off[-1]).T @ (means - off[-1]) / 6
        within += [
            np.cov(columns[runs == r].T, bias=True) for r in range(8) if NAMES[r % 2] == name
        ]
    covariance = np.mean(within, axis=0) + 1.25 * between
    expected = cdist(columns, np.stack(off), "mahalanobis", VI=np.linalg.inv(covariance))
    np.testing.assert_allclose(np.sqrt((one.left(columns) ** 2).sum(axis=2)), expected, rtol=1e-6)


def test_run_means_are_whitened_by_what_runs_differ_and_one_run_more():
    """Of windows within a run; by scipy's distance from means and covariances made here."""
    table, labels, runs = made(5)
    columns = table[:, :3]
    one = fitted_to_means(pooled(moments_of(columns, labels, runs), NAMES), 0, 0.0)
    means = np.stack([columns[runs == run].mean(axis=0) for run in range(8)])
    within = [np.cov(columns[runs == run].T, bias=True) for run in range(8)]
    centres = np.stack([means[0::2].mean(axis=0), means[1::2].mean(axis=0)])
    left = means - centres[np.arange(8) % 2]
    covariance = (left.T @ left + np.mean(within, axis=0)) / (8 - 2 + 1)
    expected = cdist(columns, centres, "mahalanobis", VI=np.linalg.inv(covariance))
    np.testing.assert_allclose(np.sqrt((one.left(columns) ** 2).sum(axis=2)), expected, rtol=1e-6)


def test_a_long_run_counts_as_a_short_one():
    table, labels, runs = made(4)
    longer = np.concatenate([np.arange(320), np.flatnonzero(runs == 0)])
    one = fitted(table, labels, runs)
    other = fitted(table[longer], labels[longer], runs[longer])
    np.testing.assert_allclose(one.means, other.means, atol=1e-9)


def test_a_missing_number_counts_as_the_mean_of_its_run():
    table, labels, runs = made(5)
    table[0, 0] = np.nan
    moments = moments_of(table, labels, runs)
    np.testing.assert_allclose(moments.means[0, 0], np.nanmean(table[runs == 0, 0]))
    assert np.isfinite(moments.covariances).all()


def test_the_space_of_discriminants_holds_all_that_tells_terrains_apart():
    """Distances to two means differ by as much there as in all columns."""
    table, labels, runs = made(6)
    one = fitted(table, labels, runs)
    left = one.left(table)
    whole, within = (left**2).sum(axis=2), ((left @ one.between.T) ** 2).sum(axis=2)
    assert one.between.shape == (1, 3)
    np.testing.assert_allclose(np.diff(whole), np.diff(within), atol=1e-8)
    assert (within <= whole + 1e-9).all()
