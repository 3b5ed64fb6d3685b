"""Samples of a trained model beside those of a new camera."""

from collections.abc import Mapping
from dataclasses import dataclass
from typing import Self

import numpy as np

from odometry.arrays import AnyArray, FloatArray, IntArray
from terrain.classification.neighbours.metric import equal_shares
from terrain.classification.neighbours.validation import Samples

LEAST_SPREAD = 1e-9  # of a feature: one that does not vary stays finite


@dataclass(frozen=True)
class OldSamples:
    """What a model was trained on, in part: features (n, F) and terrains (n,) by name."""

    features: FloatArray
    labels: AnyArray

    def arrays(self, classes: AnyArray) -> dict[str, AnyArray]:
        """Arrays of a model file, with half the bytes of what was learned from."""
        return {
            "sample_features": self.features.astype(np.float32),
            "sample_codes": np.searchsorted(classes, self.labels),
        }

    @classmethod
    def from_arrays(cls, arrays: Mapping[str, AnyArray], classes: AnyArray) -> Self | None:
        """Rebuild from what `arrays` gave; None of files of version 0.9, which have none.

        Raises
        ------
        KeyError, ValueError
            If the arrays do not fit.
        """
        if "sample_features" not in arrays:
            return None
        features, codes = arrays["sample_features"], arrays["sample_codes"]
        if features.ndim != 2 or codes.shape != features.shape[:1] or codes.dtype.kind != "i":
            raise ValueError(f"samples of shapes {features.shape}, {codes.shape}")
        if len(codes) and not 0 <= codes.min() <= codes.max() < len(classes):
            raise ValueError(f"codes of samples do not name {len(classes)} classes")
        return cls(features.astype(np.float64), classes[codes])

    def of_terrains(self, names: AnyArray) -> Self:
        """Those of some terrains."""
        kept = np.isin(self.labels, names)
        return type(self)(self.features[kept], self.labels[kept])


@dataclass(frozen=True)
class SamplesBesideOld(Samples):
    """Samples of a new camera, and old ones that are always trained on and never held out.

    Old samples are moved to where the new camera would have put them: each feature gets the mean
    and the deviation that the new samples have that are learned from, terrains in equal parts.

    Attributes
    ----------
    old, old_codes : FloatArray, shape (n, F); IntArray, shape (n,)
    """

    old: FloatArray
    old_codes: IntArray

    def with_copies(
        self, rows: IntArray, copies: Samples | None
    ) -> tuple[FloatArray, IntArray, int, FloatArray]:
        """As for `Samples`, the old ones last; they count as copies, which are not familiar.

        Every sample of a terrain has the same share: photographs of old ones are not known.
        """
        features, codes, count, _ = super().with_copies(rows, copies)
        known = np.isin(self.old_codes, self.codes[rows])
        there, deviation = _balanced(self.features[rows], self.codes[rows])
        here, spread = _balanced(self.old[known], self.old_codes[known])
        moved = there + (self.old - here) / np.maximum(spread, LEAST_SPREAD) * deviation
        every = np.concatenate([codes, self.old_codes])
        shares = equal_shares(every, np.arange(len(every)))
        return np.concatenate([features, moved]), every, count + len(moved), shares


def _balanced(features: FloatArray, codes: IntArray) -> tuple[FloatArray, FloatArray]:
    """Mean and deviation (F,) of samples, each class with equal weight."""
    weights = 1.0 / np.bincount(codes)[codes]
    mean = np.average(features, axis=0, weights=weights)
    return mean, np.sqrt(np.average((features - mean) ** 2, axis=0, weights=weights))
