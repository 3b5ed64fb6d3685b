"""Nearest neighbours: who they are, how they vote, and how far away they are.

`DiscriminantNeighbours` is the default's, `PlainNeighbours` (in `presets`) the paper's.
"""

from collections.abc import Mapping, Sequence
from copy import copy
from typing import Protocol, Self

import numpy as np
from scipy.spatial.distance import cdist
from sklearn.pipeline import make_pipeline

from odometry.arrays import AnyArray, FloatArray, IntArray
from terrain.classification.neighbours.metric import (
    MOST,
    AppearanceMetric,
    ClippedScaler,
    DiscriminantMetric,
    FourierFeatures,
)
from terrain.classification.neighbours.nearest import (
    VOTERS,
    LocalSparsity,
    brute_force,
    classes_left_open,
    labels_and_sample_distances,
)

Shares = FloatArray | None
SMALLEST = np.finfo(float).tiny  # sparsity of a patch that several samples equal


class Neighbours(Protocol):
    """What the classifier needs of its nearest neighbours."""

    class_weights_: FloatArray

    def fit(
        self, features: FloatArray, codes: IntArray, copies: int = 0, shares: Shares = None
    ) -> Self:
        """Learn from features (n, F), class codes and shares (n,); the last are altered copies."""

    def labels(self, features: FloatArray, k: int) -> IntArray:
        """Return the class codes of the k nearest training samples, nearest first, (n, k)."""

    def distances(self, features: FloatArray) -> FloatArray:
        """Return the distances to the nearest class, (n,)."""

    def labels_and_distances(self, features: FloatArray, k: int) -> tuple[IntArray, FloatArray]:
        """Return both, with nothing computed twice."""

    def labels_and_image_distances(
        self, features: FloatArray, k: int, images: Sequence[IntArray]
    ) -> tuple[IntArray, FloatArray]:
        """Return the codes of the k nearest of each patch (n, k), and the distance of each image.

        `images` holds rows of `features`: the patches of an image are judged together.
        """

    def arrays(self) -> dict[str, AnyArray]:
        """Return everything learned, by name."""

    @classmethod
    def from_arrays(cls, arrays: Mapping[str, AnyArray]) -> Self:
        """Rebuild from what `arrays` gave; KeyError or ValueError if they do not fit."""


def vote(labels: IntArray, class_weights: FloatArray) -> FloatArray:
    """Turn the neighbours' classes into probabilities.

    Parameters
    ----------
    labels : IntArray, shape (n, k)
    class_weights : FloatArray, shape (classes,)
        The weight of one neighbour of each class; 1 throughout in the paper.

    Returns
    -------
    FloatArray, shape (n, classes)
        Rows add up to 1. The paper decides for the largest (eq. 26).

    References
    ----------
    Chen et al. 2023, eq. 25 (g_i = k_i, here weighted).
    """
    counts = np.stack([(labels == c).sum(axis=1) for c in range(len(class_weights))], axis=1)
    votes = counts * class_weights  # eq. 25
    return np.asarray(votes / votes.sum(axis=1, keepdims=True))


class DiscriminantNeighbours:
    """Neighbours among shrunk discriminants; rare classes weigh as much as common ones.

    The discriminants are linear in scaled features and, where they may curve, in random Fourier
    features of these.

    A distance is the product of four: that to the nearest samples and that to the nearest mean of a
    class among the discriminants, the number of classes that the neighbours' vote leaves open, and
    the cube of the local sparsity among whitened principal components. The first two measure
    whether a patch is similar to any class in what distinguishes classes, the third whether its
    neighbours agree, the last whether any training patch is like it. Patches of one image are
    judged together by their mean place, see `labels_and_image_distances`. The mean and the vote
    detect another terrain, the samples what is far from all (sky, blur). Altered copies vote, but
    only what was really photographed makes a patch familiar.

    Models of files before version 0.12 have no `class_means_`: their distance is the mean distance
    to the nearest samples among the discriminants, times the local sparsity.
    """

    class_weights_: FloatArray
    class_means_: FloatArray | None

    def __init__(self, cosines: int = MOST) -> None:
        self._cosines = cosines

    def fit(
        self, features: FloatArray, codes: IntArray, copies: int = 0, shares: Shares = None
    ) -> Self:
        """Learn scale, discriminants, components and spacings from (n, F) and (n,)."""
        self.pipeline_ = make_pipeline(
            ClippedScaler(), FourierFeatures(self._cosines), DiscriminantMetric(), brute_force()
        )
        self.pipeline_.fit(features, codes, discriminantmetric__shares=shares)
        self.class_weights_ = 1.0 / np.bincount(codes)
        seen = len(features) - copies
        places = self.samples()[0][:seen]
        self.class_means_ = np.array(
            [places[codes[:seen] == c].mean(axis=0) for c in range(len(self.class_weights_))]
        )
        scaled = self.pipeline_[0].transform(features[:seen])
        self.appearance_ = AppearanceMetric().fit(scaled)
        self.sparsity_ = LocalSparsity().fit(self.appearance_.transform(scaled))
        return self

    def labels(self, features: FloatArray, k: int) -> IntArray:
        """Return the class codes of the k nearest, (n, k)."""
        return self.labels_and_distances(features, k)[0]

    def distances(self, features: FloatArray) -> FloatArray:
        """Return the distances to the nearest class, (n,)."""
        return self.labels_and_distances(features, 1)[1]

    def labels_and_distances(self, features: FloatArray, k: int) -> tuple[IntArray, FloatArray]:
        """Return both."""
        if self.class_means_ is not None:
            alone = list(np.arange(len(features))[:, None])
            return self.labels_and_image_distances(features, k, alone)
        place, sparsity = self._places(features)
        labels, distances = labels_and_sample_distances(
            self.pipeline_[-1], place, k, len(self.sparsity_.points_)
        )
        return labels, distances * sparsity

    def labels_and_image_distances(
        self, features: FloatArray, k: int, images: Sequence[IntArray]
    ) -> tuple[IntArray, FloatArray]:
        """Return the codes of the k nearest of each patch, and the distance of each image.

        Distances to the samples and to the class means are those of the mean place of an image's
        patches among the discriminants, where what varies from patch to patch cancels; the other
        two factors are geometric means over the patches.

        Raises
        ------
        ValueError
            If the model is of a file before version 0.12, without class means.
        """
        knn, means = self.pipeline_[-1], self.class_means_
        if means is None:
            raise ValueError("no class means, and image_rejection_distances")
        seen, wanted = len(self.sparsity_.points_), min(max(k, VOTERS), knn.n_samples_fit_)
        places, sparsity = self._places(features)
        labels, _ = labels_and_sample_distances(knn, places, wanted, seen)
        left_open = classes_left_open(vote(labels[:, :VOTERS], self.class_weights_))
        doubt = np.log(left_open) + 3 * np.log(np.maximum(sparsity, SMALLEST))
        middles = np.array([places[rows].mean(axis=0) for rows in images])
        _, to_samples = labels_and_sample_distances(knn, middles, 1, seen)
        to_mean = cdist(middles, means).min(axis=1)
        together = np.exp([doubt[rows].mean() for rows in images])
        return labels[:, :k], to_samples * to_mean * together

    def _places(self, features: FloatArray) -> tuple[FloatArray, FloatArray]:
        """Discriminants (n, classes - 1), and local sparsity (n,)."""
        scaler, *others, _ = (step for _, step in self.pipeline_.steps)
        scaled = place = scaler.transform(features)
        for step in others:
            place = step.transform(place)
        return place, self.sparsity_.sparsity(self.appearance_.transform(scaled))

    @property
    def scaler(self) -> ClippedScaler:
        """Means and deviations of the features in training."""
        scaler: ClippedScaler = self.pipeline_[0]
        return scaler

    def rescaled(self, scaler: ClippedScaler) -> Self:
        """The same neighbours for features that `scaler` standardises."""
        other = copy(self)
        other.pipeline_ = make_pipeline(scaler, *(step for _, step in self.pipeline_.steps[1:]))
        return other

    def discriminants(self, features: FloatArray) -> FloatArray:
        """Map features (n, F) to the space of the neighbours (n, classes - 1)."""
        return np.asarray(self.pipeline_[:-1].transform(features))

    def samples(self) -> tuple[FloatArray, IntArray]:
        """Discriminants (m, classes - 1) and class codes (m,) of what was learned from."""
        return self.pipeline_[-1]._fit_X, self.pipeline_[-1]._y

    def arrays(self) -> dict[str, AnyArray]:
        """Return everything learned."""
        scaler, fourier, metric, knn = (step for _, step in self.pipeline_.steps)
        arrays = {
            "scaler_mean": scaler.mean_,
            "scaler_scale": scaler.scale_,
            "frequencies": fourier.frequencies_,
            "phases": fourier.phases_,
            "discriminants": metric.projection_,
            "points": knn._fit_X,
            "codes": knn._y,
            "appearance_offset": self.appearance_.offset_,
            "appearance_projection": self.appearance_.projection_,
            "appearance_points": self.sparsity_.points_,
            "appearance_spacings": self.sparsity_.spacings_,
        }
        if self.class_means_ is not None:
            arrays["class_means"] = self.class_means_
        return arrays

    @classmethod
    def from_arrays(cls, arrays: Mapping[str, AnyArray]) -> Self:
        """Rebuild without learning again; files of version 0.9 have no Fourier features."""
        model = cls()
        scaler, fourier, metric = ClippedScaler(), FourierFeatures(), DiscriminantMetric()
        scaler.mean_, scaler.scale_ = arrays["scaler_mean"], arrays["scaler_scale"]
        fourier.frequencies_ = arrays.get("frequencies", np.empty((len(scaler.mean_), 0)))
        fourier.phases_ = arrays.get("phases", np.empty(0))
        metric.projection_ = arrays["discriminants"]
        knn = brute_force().fit(arrays["points"], arrays["codes"])
        model.pipeline_ = make_pipeline(scaler, fourier, metric, knn)
        model.class_weights_ = 1.0 / np.bincount(arrays["codes"])
        model.class_means_ = arrays.get("class_means")
        model.appearance_ = AppearanceMetric()
        model.appearance_.offset_ = arrays["appearance_offset"]
        model.appearance_.projection_ = arrays["appearance_projection"]
        model.sparsity_ = LocalSparsity().restore(
            arrays["appearance_points"], arrays["appearance_spacings"]
        )
        return model
