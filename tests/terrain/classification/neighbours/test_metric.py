import numpy as np
import pytest
from scipy.linalg import eigh
from sklearn.covariance import ledoit_wolf, shrunk_covariance

from terrain.classification.neighbours.metric import (
    AppearanceMetric,
    ClippedScaler,
    DiscriminantMetric,
    equal_shares,
)


def test_the_scaler_standardises_and_clips(rng):
    features = rng.normal([1, -5], [2, 0.1], (4000, 2))
    scaler = ClippedScaler().fit(features)
    expected = (features - features.mean(axis=0)) / features.std(axis=0)
    np.testing.assert_allclose(scaler.transform(features), expected.clip(-3, 3), atol=1e-12)
    np.testing.assert_array_equal(scaler.transform([[1e9, -1e9]]), [[3, -3]])


def test_discriminants_have_unit_spread_within_classes(rng):
    turn = np.linalg.qr(rng.normal(size=(6, 6)))[0]
    codes = rng.integers(0, 3, 20000)
    means = rng.normal(size=(3, 6)) * 3
    features = (means[codes] + rng.normal(size=(20000, 6))) @ turn
    projected = DiscriminantMetric().fit(features, codes).transform(features)
    assert projected.shape == (20000, 2)
    centres = np.array([projected[codes == c].mean(axis=0) for c in range(3)])
    np.testing.assert_allclose(np.cov((projected - centres[codes]).T), np.eye(2), atol=0.05)


def test_two_normal_classes_are_projected_on_fishers_direction(rng):
    spread = np.diag([1.0, 4.0, 9.0])
    codes = rng.integers(0, 2, 50000)
    gap = np.array([1.0, 1.0, 3.0])
    features = codes[:, None] * gap + rng.normal(size=(50000, 3)) @ np.sqrt(spread)
    direction = DiscriminantMetric().fit(features, codes).projection_[:, 0]
    fisher = np.linalg.solve(spread, gap)
    cosine = direction @ fisher / np.linalg.norm(direction) / np.linalg.norm(fisher)
    assert abs(cosine) > 0.999


@pytest.mark.parametrize("classes", [2, 5])
def test_discriminants_solve_the_generalised_problem_of_eigenvalues(classes, rng):
    codes = np.append(np.arange(classes), rng.integers(0, classes, 300))  # rare and common ones
    features = (rng.normal(size=(classes, 20))[codes] + rng.normal(size=(len(codes), 20))) * 3
    projection = DiscriminantMetric().fit(features, codes).projection_
    means = np.array([features[codes == c].mean(axis=0) for c in range(classes)])
    within = features - means[codes]
    share = ledoit_wolf(within, assume_centered=True)[1]
    covariance = shrunk_covariance(within.T @ within / len(codes), share)
    between = np.cov(means.T, fweights=np.bincount(codes), bias=True)
    _, vectors = eigh(between, covariance)
    expected = vectors[:, :-classes:-1]
    signs = np.sign(np.sum(projection * expected, axis=0))
    np.testing.assert_allclose(projection, signs * expected, atol=1e-12)


def test_shares_are_as_samples_that_are_there_so_many_times(rng):
    codes, times = rng.integers(0, 3, 4000), rng.integers(1, 5, 4000)
    features = rng.normal(size=(3, 4))[codes] + rng.normal(size=(4000, 4)) * [1, 2, 3, 4]
    given = DiscriminantMetric().fit(features, codes, times / times.sum()).projection_
    rows = np.repeat(np.arange(4000), times)
    repeated = DiscriminantMetric().fit(features[rows], codes[rows]).projection_
    signs = np.sign(np.sum(given * repeated, axis=0))
    np.testing.assert_allclose(given, signs * repeated, atol=1e-9)


def test_a_photograph_of_many_patches_does_not_decide_what_varies(rng):
    """One photograph of each class varies along the first axis, all others along the second."""
    groups = np.repeat(np.arange(22), [200, *[2] * 10, 200, *[2] * 10])
    codes = (groups > 10).astype(int)
    spread = np.where(np.isin(groups, [0, 11])[:, None], [3.0, 0.3], [0.3, 3.0])
    features = codes[:, None] + spread * rng.normal(size=(len(codes), 2))
    even = DiscriminantMetric().fit(features, codes, equal_shares(codes, groups)).projection_
    one_each = DiscriminantMetric().fit(features, codes).projection_
    assert abs(even[0, 0]) > 2 * abs(even[1, 0])
    assert abs(one_each[1, 0]) > 2 * abs(one_each[0, 0])


def test_classes_of_equal_means_have_no_discriminant_and_no_error(rng):
    features = np.vstack([noise := rng.normal(size=(30, 4)), noise])
    projected = DiscriminantMetric().fit(features, np.repeat([0, 1], 30)).transform(features)
    assert np.isfinite(projected).all()


def test_fewer_samples_than_features_still_separate(rng):
    codes = np.repeat([0, 1], 6)
    features = rng.normal(size=(12, 100))
    features[:, :40] += 2.0 * codes[:, None]
    fresh = rng.normal(size=(200, 100))
    fresh[:, :40] += 2.0 * np.repeat([0, 1], 100)[:, None]
    metric = DiscriminantMetric().fit(features, codes)
    line, cut = metric.transform(fresh)[:, 0], metric.transform(features).mean()
    assert max(np.mean((line > cut) == np.repeat(side, 100)) for side in ([0, 1], [1, 0])) > 0.9


def test_appearance_is_white_and_drops_directions_without_spread(rng):
    features = rng.normal(size=(5000, 4)) @ rng.normal(size=(4, 15))
    metric = AppearanceMetric().fit(features)
    seen = metric.transform(features)
    assert seen.shape == (5000, 4)
    np.testing.assert_allclose(np.cov(seen.T), np.eye(4), atol=1e-9)
    np.testing.assert_allclose(seen.mean(axis=0), 0, atol=1e-9)
    many = AppearanceMetric().fit(rng.normal(size=(500, 30)))
    assert many.transform(np.zeros((1, 30))).shape == (1, 10)


@pytest.mark.parametrize("count", [8, 400])
def test_appearance_is_the_widest_directions_of_few_samples_and_of_many(rng, count):
    features = rng.normal(size=(count, 60)) @ rng.normal(size=(60, 60)) + 5.0
    metric = AppearanceMetric().fit(features)
    directions = min(count - 1, 10)
    widest = np.linalg.eigvalsh(np.cov(features.T))[: -directions - 1 : -1]
    seen = metric.transform(features)
    np.testing.assert_allclose(np.cov(seen.T), np.eye(directions), atol=1e-9)
    lengths = np.linalg.norm(metric.projection_, axis=0)
    np.testing.assert_allclose(lengths, 1 / np.sqrt(widest), rtol=1e-9)
