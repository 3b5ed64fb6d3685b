"""The paper's nearest neighbours."""

from collections.abc import Mapping, Sequence
from typing import Self

import numpy as np
from sklearn.pipeline import make_pipeline

from odometry.arrays import AnyArray, FloatArray, IntArray
from terrain.classification.nearest import brute_force, labels_and_sample_distances


class PlainNeighbours:
    """Euclidean neighbours of unscaled features, one vote each (Chen et al. 2023, eq. 24-25)."""

    class_weights_: FloatArray

    def fit(self, features: FloatArray, codes: IntArray, copies: int = 0) -> Self:  # noqa: ARG002
        """Remember features (n, F) and class codes (n,), copies or not."""
        self.pipeline_ = make_pipeline(brute_force()).fit(features, codes)
        self.class_weights_ = np.ones(int(codes.max()) + 1)
        return self

    def labels(self, features: FloatArray, k: int) -> IntArray:
        """Return the class codes of the k nearest, (n, k)."""
        return self.labels_and_distances(features, k)[0]

    def distances(self, features: FloatArray) -> FloatArray:
        """Return the mean Euclidean distances to the nearest samples, (n,)."""
        return self.labels_and_distances(features, 1)[1]

    def labels_and_distances(self, features: FloatArray, k: int) -> tuple[IntArray, FloatArray]:
        """Return both."""
        knn = self.pipeline_[-1]
        return labels_and_sample_distances(knn, features, k, knn.n_samples_fit_)  # eq. 24

    def labels_and_image_distances(
        self, features: FloatArray, k: int, images: Sequence[IntArray]
    ) -> tuple[IntArray, FloatArray]:
        """Return the codes of the k nearest, and the median distance of the patches of images."""
        labels, distances = self.labels_and_distances(features, k)
        return labels, np.array([np.median(distances[rows]) for rows in images])

    def arrays(self) -> dict[str, AnyArray]:
        """Return the training samples."""
        return {"points": self.pipeline_[-1]._fit_X, "codes": self.pipeline_[-1]._y}

    @classmethod
    def from_arrays(cls, arrays: Mapping[str, AnyArray]) -> Self:
        """Rebuild from the training samples."""
        return cls().fit(arrays["points"], arrays["codes"])
