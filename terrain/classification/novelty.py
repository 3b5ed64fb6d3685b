"""How much sparser training samples lie around a sample than around its neighbours."""

from typing import Self

import numpy as np
from sklearn.neighbors import NearestNeighbors

from odometry.arrays import FloatArray
from terrain.classification.nearest import nearest

NEIGHBOURS = 5
SMALLEST_SHARE_OF_MEAN = 0.01


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
