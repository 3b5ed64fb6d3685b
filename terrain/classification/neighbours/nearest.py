"""The nearest of a set of points, and how unlike them a point is."""

from typing import Self

import numpy as np
from sklearn.neighbors import KNeighborsClassifier, NearestNeighbors

from odometry.arrays import FloatArray, IntArray

NEIGHBOURS = 5  # whose mean distance is that to the samples

SMALLEST_SHARE_OF_MEAN = 0.01
VOTERS = 25  # neighbours whose vote says how many classes are left open, whatever the k


def nearest(points: FloatArray, queries: FloatArray, k: int) -> tuple[FloatArray, IntArray]:
    """The k nearest points of each query, nearest first.

    Parameters
    ----------
    points : (n, d) array
    queries : (m, d) array
    k : int
        At most n.

    Returns
    -------
    (m, k) array, (m, k) array
        Euclidean distances and rows of `points`. Of points equally far the earlier comes first.
    """
    # |p|^2 - 2 p.q orders points as the distance does, to rounding; distances are then exact
    order = (points**2).sum(axis=1) - 2.0 * (queries @ points.T)
    found = np.argpartition(order, k - 1, axis=1)[:, :k] if k < len(points) else _all(order)
    apart = (queries[:, None] - points[found]).transpose(2, 0, 1)
    distances = np.sqrt((apart * apart).sum(axis=0))
    by_distance = np.lexsort((found, distances))
    rows = np.arange(len(queries))[:, None]
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


def classes_left_open(votes: FloatArray) -> FloatArray:
    """How many classes votes (n, classes) leave open, (n,): exp(H) with the entropy H of a vote.

    It is 1 where all neighbours agree, and the number of classes where they are split evenly.
    """
    logarithms = np.log(np.where(votes > 0, votes, 1.0))
    return np.asarray(np.exp(-(votes * logarithms).sum(axis=1)))


class LocalSparsity:
    """Distance to the nearest training samples over those samples' own spacing.

    A simple local outlier factor: about 1 inside the training samples, wherever they are dense
    or sparse, and large outside. Spacings below a hundredth of the mean count as that, so that
    repeated samples do not make their surroundings infinitely far.

    Attributes
    ----------
    points_ : FloatArray, shape (n, d)
    spacings_ : FloatArray, shape (n,)
        Mean distance of each training sample to its nearest others.

    References
    ----------
    Breunig, Kriegel, Ng and Sander 2000, "LOF: identifying density-based local outliers".
    """

    def fit(self, points: FloatArray) -> Self:
        """Learn the spacings of `points` (n, d), n at least 2."""
        k = min(NEIGHBOURS, len(points) - 1)
        distances, _ = NearestNeighbors(n_neighbors=k, algorithm="brute").fit(points).kneighbors()
        spacings = distances.mean(axis=1)
        floor = max(SMALLEST_SHARE_OF_MEAN * float(spacings.mean()), np.finfo(float).eps)
        return self.restore(points, np.maximum(spacings, floor))

    def restore(self, points: FloatArray, spacings: FloatArray) -> Self:
        """Take over points and spacings that were learned before."""
        self.points_, self.spacings_ = points, spacings
        return self

    def sparsity(self, points: FloatArray) -> FloatArray:
        """Return the ratio for each of `points` (n, d), shape (n,)."""
        k = min(NEIGHBOURS, len(self.points_) - 1)
        distances, indices = nearest(self.points_, points, k)
        return np.asarray(distances.mean(axis=1) / self.spacings_[indices].mean(axis=1))
