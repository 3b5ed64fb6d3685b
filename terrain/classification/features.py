"""Feature vectors of ground patches: SFTA of the grey image and of filtered copies of it."""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import Any, Self

import numpy as np

from odometry.arrays import ByteImage, FloatArray
from terrain.classification.filters import (
    Filter,
    band_pass,
    coherence,
    gradient_magnitude,
    gradient_orientation,
    local_contrast,
    red_green,
    reduced,
    yellow_blue,
)
from terrain.images import to_grey
from terrain.texture import feature_names as names_of_sfta
from terrain.texture import sfta

GREY_COPIES: dict[str, Filter] = {
    "grey": reduced(1),
    "grey_2": reduced(2),
    "grey_4": reduced(4),
    "magnitude_0.7": gradient_magnitude(0.7),
    "magnitude_1.4": gradient_magnitude(1.4),
    "magnitude_2.8": gradient_magnitude(2.8),
    "orientation_0.7": gradient_orientation(0.7),
    "orientation_1.4": gradient_orientation(1.4),
    "orientation_2.8": gradient_orientation(2.8),
    "coherence_0.7": coherence(0.7),
    "coherence_1.4": coherence(1.4),
    "coherence_2.8": coherence(2.8),
    "contrast_2": local_contrast(2.0),
    "contrast_5.6": local_contrast(5.6),
    "contrast_16": local_contrast(16.0),
    "band_0.7": band_pass(0.7),
    "band_1": band_pass(1.0),
    "band_2": band_pass(2.0),
    "band_4": band_pass(4.0),
}
COLOUR_COPIES: dict[str, Filter] = {"red_green": red_green, "yellow_blue": yellow_blue}


@dataclass(frozen=True)
class FeatureSettings:
    """What is computed of a patch: copies by name, thresholds per copy, the unit of counts."""

    grey_copies: tuple[str, ...]
    colour_copies: tuple[str, ...]
    n_thresholds: int
    counts_per_area: bool

    @classmethod
    def from_table(cls, table: Mapping[str, Any]) -> Self:
        """Read back what `dataclasses.asdict` and JSON made; ValueError for an unknown copy."""
        grey, colour = tuple(table["grey_copies"]), tuple(table["colour_copies"])
        unknown = (set(grey) - set(GREY_COPIES)) | (set(colour) - set(COLOUR_COPIES))
        if unknown:
            raise ValueError(f"copies that this program does not know: {sorted(unknown)}")
        return cls(grey, colour, int(table["n_thresholds"]), bool(table["counts_per_area"]))


def patch_features(image: ByteImage, settings: FeatureSettings) -> FloatArray:
    """Return the features of one patch: per copy D, C and G of ``2 * n_thresholds`` binary images.

    Parameters
    ----------
    image : ByteImage, shape (rows, columns) or (rows, columns, 3)
        Colour copies need RGB.
    settings : FeatureSettings

    Returns
    -------
    FloatArray, shape (6 * n_thresholds * copies,)
        C is divided by the area of the copy if `settings.counts_per_area`.
    """
    grey = to_grey(image).astype(np.float32)
    copies = [GREY_COPIES[name](grey) for name in settings.grey_copies]
    copies += [COLOUR_COPIES[name](image) for name in settings.colour_copies]
    features = np.array([sfta(copy, n_thresholds=settings.n_thresholds) for copy in copies])
    if settings.counts_per_area:
        features[:, 1::3] /= np.array([[copy.size] for copy in copies])
    return features.ravel()


def feature_names(settings: FeatureSettings) -> list[str]:
    """The name of each of the features: copy, quantity and number of the binary image."""
    copies = (*settings.grey_copies, *settings.colour_copies)
    return [f"{copy}_{name}" for copy in copies for name in names_of_sfta(settings.n_thresholds)]


def feature_matrix(images: Sequence[ByteImage], settings: FeatureSettings) -> FloatArray:
    """Return the features of each patch as a row, shape (patches, features)."""
    return np.array([patch_features(image, settings) for image in images])
