import numpy as np

from terrain.classification.neighbours.nearest import LocalSparsity, classes_left_open


def by_loops(points, queries, k=5):
    """The definition, one distance at a time."""

    def nearest(point, others):
        order = sorted(range(len(others)), key=lambda i: np.linalg.norm(point - others[i]))[:k]
        return order, np.mean([np.linalg.norm(point - others[i]) for i in order])

    spacing = [nearest(points[i], np.delete(points, i, axis=0))[1] for i in range(len(points))]
    answers = []
    for query in queries:
        order, distance = nearest(query, points)
        answers.append(distance / np.mean([spacing[i] for i in order]))
    return answers


def test_the_ratio_is_its_definition(rng):
    points, queries = rng.normal(size=(40, 3)), 2 * rng.normal(size=(20, 3))
    sparsity = LocalSparsity().fit(points)
    np.testing.assert_allclose(sparsity.sparsity(queries), by_loops(points, queries))
    np.testing.assert_allclose(
        LocalSparsity().fit(7 * points).sparsity(7 * queries), sparsity.sparsity(queries)
    )


def test_dense_and_sparse_samples_are_equally_familiar(rng):
    dense, sparse = rng.normal(0, 0.1, (500, 2)), rng.normal(50, 5, (500, 2))
    sparsity = LocalSparsity().fit(np.vstack([dense, sparse]))
    fresh = sparsity.sparsity(
        np.vstack([rng.normal(0, 0.1, (200, 2)), rng.normal(50, 5, (200, 2))])
    )
    assert 0.8 < np.median(fresh[:200]) < 1.3
    assert 0.8 < np.median(fresh[200:]) < 1.3
    assert sparsity.sparsity(np.array([[5.0, 5.0]])) > 20


def test_repeated_samples_leave_the_ratio_finite():
    points = np.repeat([[0.0, 0.0], [1.0, 0.0]], 10, axis=0)
    assert np.isfinite(LocalSparsity().fit(points).sparsity(np.array([[0.0, 1.0]]))).all()
    np.testing.assert_array_equal(LocalSparsity().fit(points).sparsity(points), 0)


def test_two_samples_suffice():
    sparsity = LocalSparsity().fit(np.array([[0.0], [2.0]]))
    np.testing.assert_allclose(sparsity.sparsity(np.array([[3.0]])), 0.5)


def test_classes_left_open_by_hand():
    votes = np.array([[1, 0, 0, 0], [0.5, 0, 0.5, 0], [0.25, 0.25, 0.25, 0.25]])
    np.testing.assert_allclose(classes_left_open(votes), [1, 2, 4])
    assert 1 < classes_left_open(np.array([[0.9, 0.1]]))[0] < 2
