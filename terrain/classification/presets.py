"""The two ways to classify terrain, as a table, and the paper's nearest neighbours."""

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass
from typing import Self

import numpy as np
from sklearn.pipeline import make_pipeline

from odometry.arrays import AnyArray, FloatArray, IntArray
from terrain.classification.features.copies import COLOUR_COPIES, GREY_COPIES
from terrain.classification.features.features import FEWER_GREYS, FeatureSettings
from terrain.classification.neighbours.nearest import brute_force, labels_and_sample_distances
from terrain.classification.neighbours.neighbours import (
    DiscriminantNeighbours,
    Neighbours,
)


class PlainNeighbours:
    """Euclidean neighbours of unscaled features, one vote each (Chen et al. 2023, eq. 24-25)."""

    class_weights_: FloatArray

    def fit(
        self,
        features: FloatArray,
        codes: IntArray,
        copies: int = 0,  # noqa: ARG002
        shares: FloatArray | None = None,  # noqa: ARG002
    ) -> Self:
        """Remember features (n, F) and class codes (n,), copies or not, each with one vote."""
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


def linear_neighbours() -> DiscriminantNeighbours:
    """Neighbours among linear discriminants."""
    return DiscriminantNeighbours(cosines=0)


@dataclass(frozen=True)
class Preset:
    """What a preset computes of a patch, and how it looks for neighbours.

    Attributes
    ----------
    features, colour_features : FeatureSettings
        Without and with colour.
    neighbours : type
        One of the classes of `terrain.classification.neighbours.neighbours`.
    ways : tuple of callable
        What makes them: cross-validation chooses one.
    neighbour_counts : tuple of int
        The numbers k of neighbours among which cross-validation chooses.
    as_published : bool
        Votes are the probabilities, nothing but the photographs is learned from, and one distance
        rejects whatever the number of patches.
    one_patch : bool
        Of the region in an image of a run the patch in its middle alone is looked at.
    """

    features: FeatureSettings
    colour_features: FeatureSettings
    neighbours: type[Neighbours]
    ways: tuple[Callable[[], Neighbours], ...]
    neighbour_counts: tuple[int, ...]
    as_published: bool = False
    one_patch: bool = False


_CHEN2023 = FeatureSettings(("grey",), (), n_thresholds=4, counts_per_area=False)
_ALL_GREY = tuple(GREY_COPIES)
_SCALES = ("grey", "grey_2", "grey_4")  # with statistics beside them, the others bring no more
_ALL_COLOUR = tuple(COLOUR_COPIES)
_FEW_GREY = ("grey", "magnitude_0.7", "coherence_0.7", "band_2")  # chosen one after another
_BOTH = ("joint", "gabor")
_DISCRIMINANT = (
    DiscriminantNeighbours,
    (linear_neighbours, DiscriminantNeighbours),
    (5, 9, 15, 25, 45),
)


def _of(
    grey_copies: tuple[str, ...],
    colour_copies: tuple[str, ...] = (),
    statistics: tuple[str, ...] = (),
) -> FeatureSettings:
    return FeatureSettings(grey_copies, colour_copies, 4, True, FEWER_GREYS, statistics)


PRESETS = {
    "default": Preset(_of(_SCALES, (), _BOTH), _of(_ALL_GREY, _ALL_COLOUR, _BOTH), *_DISCRIMINANT),
    "fast": Preset(_of(_FEW_GREY), _of(_FEW_GREY, _ALL_COLOUR), *_DISCRIMINANT, one_patch=True),
    "chen2023": Preset(
        _CHEN2023,
        _CHEN2023,
        PlainNeighbours,
        (PlainNeighbours,),
        (1, 3, 5, 9, 15),
        as_published=True,
    ),
}
