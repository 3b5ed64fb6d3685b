"""The nearest of a set of points, by one matrix product for all queries."""

import numpy as np
from sklearn.neighbors import KNeighborsClassifier

from odometry.arrays import FloatArray, IntArray

NEIGHBOURS = 5  # whose mean distance is that to the samples


def nearest(points: FloatArray, asked: FloatArray, k: int) -> tuple[FloatArray, IntArray]:
    """The k nearest points of each query, nearest first.

    Parameters
    ----------
    points : (n, d) array
    asked : (m, d) array
    k : int
        At most n.

    Returns
    -------
    (m, k) array, (m, k) array
        Euclidean distances and rows of `points`. Of points equally far the earlier comes first.
    """
    # |p|^2 - 2 p.q orders points as the distance does, to rounding; distances are then exact
    order = (points**2).sum(axis=1) - 2.0 * (asked @ points.T)
    found = np.argpartition(order, k - 1, axis=1)[:, :k] if k < len(points) else _all(order)
    apart = (asked[:, None] - points[found]).transpose(2, 0, 1)
    distances = np.sqrt((apart * apart).sum(axis=0))
    by_distance = np.lexsort((found, distances))
    rows = np.arange(len(asked))[:, None]
    return distances[rows, by_distance], found[rows, by_distance]


def _all(order: FloatArray) -> IntArray:
    return np.tile(np.arange(order.shape[1]), (len(order), 1))


def brute_force() -> KNeighborsClassifier:
    """What holds samples and their classes."""
    return KNeighborsClassifier(n_neighbors=1, algorithm="brute")


def labels_and_sample_distances(
    knn: KNeighborsClassifier, places: FloatArray, k: int, seen: int
) -> tuple[IntArray, FloatArray]:
    """Class codes (n, k) of the k nearest samples, and the mean distance (n,) of the nearest.

    The first `seen` samples are no altered copies: the distance is to these.
    """
    few = min(NEIGHBOURS, seen)
    distances, rows = nearest(knn._fit_X, places, max(k, few))
    if seen < knn.n_samples_fit_:
        distances, _ = nearest(knn._fit_X[:seen], places, few)
    return np.asarray(knn._y[rows[:, :k]], dtype=np.int64), distances[:, :few].mean(axis=1)
