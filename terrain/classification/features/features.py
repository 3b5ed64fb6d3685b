"""Feature vectors of patches: SFTA of the grey image and of filtered copies of it, and statistics.

SFTA comes first.
"""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import Any, Self

import numpy as np

from odometry.arrays import BoolArray, ByteImage, FloatArray
from terrain.classification.features.copies import COLOUR_COPIES, GREY_COPIES, ITSELF, Copies
from terrain.classification.features.patch_statistics import STATISTICS
from terrain.texture import feature_names as names_of_sfta
from terrain.texture.box_counting import byte_histogram
from terrain.texture.coarse_otsu import coarse_otsu
from terrain.texture.otsu import multilevel_otsu
from terrain.texture.stack import features_between
from terrain.texture.ttbd import VARIANTS

ALL_GREYS, FEWER_GREYS = 256, 64
TOGETHER = 8  # patches; what is made of them stays in the cache


@dataclass(frozen=True)
class FeatureSettings:
    """What is computed of a patch.

    Attributes
    ----------
    grey_copies, colour_copies : tuple of str
        Those that SFTA describes, by name. With colour copies, the statistics are in colour too.
    n_thresholds : int
        For each copy.
    counts_per_area : bool
        The unit of counts: shares of the copy, or pixels.
    filtered_greys : int
        Bins of the histogram in which the thresholds of filtered copies are found; those of the
        grey image itself are exact.
    statistics : tuple of str
        What stands beside SFTA, by name: "joint" and "gabor".
    """

    grey_copies: tuple[str, ...]
    colour_copies: tuple[str, ...]
    n_thresholds: int
    counts_per_area: bool
    filtered_greys: int = ALL_GREYS
    statistics: tuple[str, ...] = ()

    @classmethod
    def from_table(cls, table: Mapping[str, Any]) -> Self:
        """Read back what `dataclasses.asdict` and JSON made; ValueError for an unknown name."""
        grey, colour = tuple(table["grey_copies"]), tuple(table["colour_copies"])
        unknown = (set(grey) - set(GREY_COPIES)) | (set(colour) - set(COLOUR_COPIES))
        if unknown:
            raise ValueError(f"copies that this program does not know: {sorted(unknown)}")
        statistics = tuple(table.get("statistics", ()))  # older files have none
        if strange := set(statistics) - set(STATISTICS):
            raise ValueError(f"statistics that this program does not know: {sorted(strange)}")
        greys = int(table.get("filtered_greys", ALL_GREYS))  # files of version 0.9 have none
        if greys not in {ALL_GREYS, FEWER_GREYS}:
            raise ValueError(f"filtered_greys = {greys}, expected {ALL_GREYS} or {FEWER_GREYS}")
        n_thresholds, per_area = int(table["n_thresholds"]), bool(table["counts_per_area"])
        return cls(grey, colour, n_thresholds, per_area, greys, statistics)


def patch_features(images: Sequence[ByteImage], settings: FeatureSettings) -> FloatArray:
    """Features of patches as rows: SFTA of each copy, then the statistics of `settings`.

    SFTA is D, C and G of ``2 * n_thresholds`` binary images for each copy.

    Parameters
    ----------
    images : sequence of ByteImage, shape (rows, columns) or (rows, columns, 3)
        Colour copies need RGB.
    settings : FeatureSettings

    Returns
    -------
    FloatArray, shape (patches, 6 * n_thresholds * copies + number of statistics)
        C is divided by the area of the copy if `settings.counts_per_area`.
    """
    names = (*settings.grey_copies, *settings.colour_copies)
    patches = [Copies(image) for image in images]
    copies = [patch[name] for patch in patches for name in names]
    histograms = np.stack([byte_histogram(copy) for copy in copies])
    is_itself = np.array([name == ITSELF for name in names] * len(images))
    thresholds = _thresholds(histograms, is_itself, settings)
    features = np.empty((len(copies), 2 * settings.n_thresholds, 3))
    for of in _alike(copies):
        greys = np.stack([copies[i] for i in of])
        rows = features_between(greys, histograms[of], thresholds[of], VARIANTS["chen2023"])
        features[of] = rows.reshape(len(of), -1, 3)
        if settings.counts_per_area:
            features[of, :, 1] /= greys[0].size
    beside = np.stack([_statistics(patch, settings) for patch in patches])
    return np.hstack([features.reshape(len(images), -1), beside])


def _thresholds(
    histograms: FloatArray, is_itself: BoolArray, settings: FeatureSettings
) -> FloatArray:
    """Thresholds (N, n_t) of copies with histograms (N, 256); exact for the image itself."""
    n_thresholds = settings.n_thresholds
    exact = is_itself | (settings.filtered_greys == ALL_GREYS)
    thresholds = np.empty((len(histograms), n_thresholds))
    for row in np.flatnonzero(exact):
        thresholds[row] = multilevel_otsu(histograms[row], n_thresholds)
    thresholds[~exact] = coarse_otsu(histograms[~exact], n_thresholds, settings.filtered_greys)
    return thresholds


def _statistics(patch: Copies, settings: FeatureSettings) -> FloatArray:
    """What stands beside SFTA in the features of a patch, (n,)."""
    colour = bool(settings.colour_copies)
    groups = [STATISTICS[name].of(patch, colour) for name in settings.statistics]
    return np.concatenate([*groups, np.empty(0)])


def _alike(copies: Sequence[ByteImage]) -> list[list[int]]:
    """Places of copies of one size."""
    places: dict[tuple[int, ...], list[int]] = {}
    for place, copy in enumerate(copies):
        places.setdefault(copy.shape, []).append(place)
    return list(places.values())


def feature_names(settings: FeatureSettings) -> list[str]:
    """The name of each feature: copy, quantity and number of the binary image; then statistics."""
    copies, colour = (*settings.grey_copies, *settings.colour_copies), bool(settings.colour_copies)
    names = [f"{copy}_{name}" for copy in copies for name in names_of_sfta(settings.n_thresholds)]
    return names + [
        name for group in settings.statistics for name in STATISTICS[group].names(colour)
    ]


def feature_matrix(images: Sequence[ByteImage], settings: FeatureSettings) -> FloatArray:
    """Return the features of each patch as a row, shape (patches, features)."""
    starts = range(0, len(images), TOGETHER)
    return np.concatenate([patch_features(images[i : i + TOGETHER], settings) for i in starts])
