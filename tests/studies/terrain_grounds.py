"""Features of folders of photographs, and classifiers chosen on training photographs alone."""

from dataclasses import dataclass
from pathlib import Path

import numpy as np

from odometry.arrays import AnyArray, FloatArray, IntArray
from terrain.classification.evaluation import balanced_accuracy
from terrain.classification.feature_jobs import shared_feature_matrix
from terrain.classification.neighbours import Neighbours, vote
from terrain.classification.patches import find_photos, load_patches
from terrain.classification.presets import PRESETS, Preset
from terrain.classification.validation import Samples, cross_validate

REJECTED_SHARE = 0.05
COPIES = {"grey": 1, "scales": 3, "bank": 19, "bank and colour": 21}
PER_COPY = 24


@dataclass(frozen=True)
class Grounds:
    """The patches of one folder: features of either preset, classes and photographs."""

    plain: FloatArray
    bank: FloatArray
    labels: AnyArray
    groups: AnyArray
    photos: AnyArray

    def only(self, rows: AnyArray) -> "Grounds":
        """Some of the patches."""
        return Grounds(*(getattr(self, name)[rows] for name in self.__dataclass_fields__))

    @property
    def codes(self) -> IntArray:
        """Classes as numbers, in alphabetical order."""
        return np.unique(self.labels, return_inverse=True)[1]


def read_grounds(folder: Path, size_px: int, store: Path) -> Grounds:
    """Compute the features of a folder of photographs, or read them from `store`."""
    file = store / f"{folder.name}_{size_px}.npz"
    if not file.exists():
        patches = load_patches(find_photos(folder), size_px)
        shared = {"processes": 1, "show_progress": True}
        plain = shared_feature_matrix(patches.images, PRESETS["chen2023"].features, **shared)
        bank = shared_feature_matrix(patches.images, PRESETS["default"].colour_features, **shared)
        names = [str(photo) for photo in patches.photos]
        np.savez(file, plain, bank, patches.labels, patches.groups, names)
        print(f"{folder.name}: {len(patches.too_small)} photographs smaller than {size_px} px")
    with np.load(file) as arrays:
        return Grounds(*(arrays[f"arr_{i}"] for i in range(5)))


@dataclass(frozen=True)
class Chosen:
    """A classifier whose every choice was made on training photographs."""

    structure: str
    columns: slice
    model: Neighbours
    k: int
    rejection_distance: float

    def probabilities(self, features: FloatArray) -> FloatArray:
        """Of each class, (n, classes)."""
        labels = self.model.labels(features[:, self.columns], self.k)
        return vote(labels, self.model.class_weights_)

    def distances(self, features: FloatArray) -> FloatArray:
        """To the nearest class, (n,)."""
        return self.model.distances(features[:, self.columns])


def choose(
    preset: Preset, structures: tuple[str, ...], features: FloatArray, train: Grounds
) -> Chosen:
    """Choose structure, k and rejection distance inside `train`, then learn from all of it."""
    best, best_score = None, -1.0
    for name in structures:
        columns = slice(0, COPIES[name] * PER_COPY)
        found = cross_validate(
            preset.neighbours,
            preset.neighbour_counts,
            Samples(features[:, columns], train.codes, train.groups),
        )
        score = balanced_accuracy(found.codes, found.probabilities.argmax(axis=1))
        if score > best_score:
            best, best_score = (name, columns, found), score
    name, columns, found = best
    model = preset.neighbours().fit(features[:, columns], train.codes)
    limit = float(np.quantile(found.distances, 1 - REJECTED_SHARE))
    return Chosen(name, columns, model, found.n_neighbors, limit)


@dataclass(frozen=True)
class Way:
    """One way to classify: a preset and the structures to choose from."""

    name: str
    preset: Preset
    structures: tuple[str, ...]

    def features(self, grounds: Grounds) -> FloatArray:
        """The matrix that the preset works on."""
        return grounds.plain if self.name == "chen2023" else grounds.bank


def joined(first: Grounds, second: Grounds) -> Grounds:
    """Both, one after the other."""
    names = first.__dataclass_fields__
    return Grounds(*(np.concatenate([getattr(first, n), getattr(second, n)]) for n in names))
