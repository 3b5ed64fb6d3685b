import numpy as np
import pytest
from scipy.stats import entropy
from sklearn.neighbors import KNeighborsClassifier

from terrain.classification.neighbours.metric import DiscriminantMetric
from terrain.classification.neighbours.neighbours import DiscriminantNeighbours, vote
from terrain.classification.presets import PlainNeighbours


@pytest.fixture
def samples(rng):
    codes = np.repeat([0, 1, 2], [60, 20, 40])
    features = rng.normal(size=(120, 8))
    features[:, :3] += 3 * np.eye(3)[codes]
    return features, codes


def test_plain_votes_are_scikit_learns(samples, rng):
    features, codes = samples
    queries = rng.normal(size=(50, 8)) + 1
    model = PlainNeighbours().fit(features, codes)
    for k in (1, 4, 15):
        expected = KNeighborsClassifier(k).fit(features, codes).predict_proba(queries)
        np.testing.assert_allclose(vote(model.labels(queries, k), model.class_weights_), expected)
    gaps = np.linalg.norm(queries[:, None] - features, axis=2)
    np.testing.assert_allclose(
        model.distances(queries), np.sort(gaps, axis=1)[:, :5].mean(axis=1), rtol=1e-6
    )


def test_weighted_votes_by_hand():
    labels = np.array([[0, 0, 0, 1], [1, 1, 2, 2]])
    np.testing.assert_allclose(
        vote(labels, np.array([1 / 6, 1 / 2, 1 / 4])), [[0.5, 0.5, 0], [0, 2 / 3, 1 / 3]]
    )


def test_rare_classes_weigh_as_much_as_common_ones(samples):
    model = DiscriminantNeighbours().fit(*samples)
    everything = vote(model.labels(samples[0], 120), model.class_weights_)
    np.testing.assert_allclose(everything, 1 / 3)


def test_classes_are_told_apart_by_what_samples_count_for(samples):
    shares = np.linspace(1, 5, 120) / np.linspace(1, 5, 120).sum()
    model = DiscriminantNeighbours(cosines=0).fit(*samples, 0, shares)
    scaled = model.scaler.transform(samples[0])
    expected = DiscriminantMetric().fit(scaled, samples[1], shares).projection_
    np.testing.assert_array_equal(model.arrays()["discriminants"], expected)
    assert np.abs(expected - DiscriminantMetric().fit(scaled, samples[1]).projection_).max() > 0.01


def test_altered_copies_vote_and_make_nothing_familiar(samples, rng):
    features, codes = samples
    altered = features + rng.normal(0, 3, features.shape)
    everything = np.concatenate([features, altered]), np.concatenate([codes, codes])
    model = DiscriminantNeighbours().fit(*everything, len(codes))
    assert model.distances(altered).mean() > 2 * model.distances(features).mean()
    alike = DiscriminantNeighbours().fit(*everything)
    assert model.distances(altered).mean() > 2 * alike.distances(altered).mean()
    np.testing.assert_array_equal(model.labels(altered, 5), alike.labels(altered, 5))
    again = DiscriminantNeighbours.from_arrays(model.arrays())
    np.testing.assert_array_equal(again.distances(altered), model.distances(altered))


def projected_by_hand(model, samples, queries):
    """Scaled features and discriminants of queries."""
    scaled = ((queries - samples[0].mean(axis=0)) / samples[0].std(axis=0)).clip(-3, 3)
    arrays = model.arrays()
    cosines = np.sqrt(2) * np.cos(scaled @ arrays["frequencies"] + arrays["phases"])
    return scaled, np.hstack([scaled, cosines]) @ arrays["discriminants"]


def test_distance_is_by_samples_class_means_open_classes_and_sparsity(samples, rng):
    model = DiscriminantNeighbours().fit(*samples)
    queries = rng.normal(size=(30, 8))
    scaled, places = projected_by_hand(model, samples, queries)
    points, codes = model.arrays()["points"], model.arrays()["codes"]
    means = np.array([points[codes == code].mean(axis=0) for code in range(3)])
    to_mean = np.linalg.norm(places[:, None] - means, axis=2).min(axis=1)
    to_points = np.linalg.norm(places[:, None] - points, axis=2)
    to_samples = np.sort(to_points, axis=1)[:, :5].mean(axis=1)
    nearest_25 = to_points.argsort(axis=1)[:, :25]
    votes = np.stack([(codes[nearest_25] == code).mean(axis=1) for code in range(3)], axis=1)
    votes /= np.bincount(codes)
    left_open = np.exp(entropy(votes, axis=1))
    sparsity = model.sparsity_.sparsity(model.appearance_.transform(scaled))
    expected = to_samples * to_mean * left_open * sparsity**3
    for k in (1, 7, 50):
        labels, distances = model.labels_and_distances(queries, k)
        np.testing.assert_allclose(distances, expected, rtol=1e-6)
        assert labels.shape == (30, k)


def test_files_without_class_means_keep_their_distances(samples, rng):
    fitted = DiscriminantNeighbours().fit(*samples)
    arrays = fitted.arrays()
    del arrays["class_means"]
    model = DiscriminantNeighbours.from_arrays(arrays)
    queries = rng.normal(size=(30, 8))
    scaled, places = projected_by_hand(fitted, samples, queries)
    gaps = np.linalg.norm(places[:, None] - arrays["points"], axis=2)
    near = np.sort(gaps, axis=1)[:, :5].mean(axis=1)
    sparsity = model.sparsity_.sparsity(model.appearance_.transform(scaled))
    np.testing.assert_allclose(model.distances(queries), near * sparsity, rtol=1e-6)
    assert "class_means" not in model.arrays()
    np.testing.assert_array_equal(model.labels(queries, 7), fitted.labels(queries, 7))


def test_unlike_samples_are_farther_by_either_factor(samples):
    features, codes = samples
    model = DiscriminantNeighbours().fit(features, codes)
    strange = np.array([[0, 0, 0, 3, -3, 3, -3, 3.0]])  # like a class, unlike any sample
    assert model.distances(strange)[0] > np.quantile(model.distances(features), 0.99)


@pytest.mark.parametrize("kind", [PlainNeighbours, DiscriminantNeighbours])
def test_arrays_bring_back_the_same_answers(kind, samples, rng):
    model = kind().fit(*samples)
    again = kind.from_arrays({name: array.copy() for name, array in model.arrays().items()})
    queries = rng.normal(size=(30, 8)) * 2
    np.testing.assert_array_equal(again.labels(queries, 7), model.labels(queries, 7))
    np.testing.assert_array_equal(again.distances(queries), model.distances(queries))
    np.testing.assert_array_equal(again.class_weights_, model.class_weights_)


@pytest.mark.parametrize("cosines", [0, 50])
def test_rescaled_by_its_own_scaler_a_model_is_what_it_was(cosines, samples, rng):
    model = DiscriminantNeighbours(cosines).fit(*samples)
    again = model.rescaled(model.scaler)
    queries = rng.normal(size=(30, 8)) * 2
    np.testing.assert_array_equal(again.labels(queries, 7), model.labels(queries, 7))
    np.testing.assert_array_equal(again.distances(queries), model.distances(queries))
