"""How unlike training samples a sample is: sparsity around it, and classes that are left open."""

from typing import Self

import numpy as np
from sklearn.neighbors import NearestNeighbors

from odometry.arrays import FloatArray
from terrain.classification.nearest import NEIGHBOURS, nearest

SMALLEST_SHARE_OF_MEAN = 0.01
ASKED = 25  # neighbours whose vote says how many classes are left open, whatever the k


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
