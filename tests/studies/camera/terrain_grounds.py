"""Features of folders of photographs, and classifiers chosen on training photographs alone."""

from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path

import numpy as np

from odometry.arrays import AnyArray, ByteImage, FloatArray, IntArray
from terrain.classification.features.feature_jobs import shared_feature_matrix
from terrain.classification.features.features import feature_names
from terrain.classification.held_out import balanced_accuracy
from terrain.classification.neighbours.calibration import tempered
from terrain.classification.neighbours.neighbours import Neighbours, vote
from terrain.classification.neighbours.rejection import (
    as_of_one_patch,
    quantiles,
    rejection_distances,
)
from terrain.classification.neighbours.validation import Samples, best_way
from terrain.classification.photographs.augmentation import Augmentation, load_copies
from terrain.classification.photographs.other_light import with_other_light
from terrain.classification.photographs.patches import (
    LabelledPatches,
    find_photos,
    load_patches,
)
from terrain.classification.presets import PRESETS, Preset

REJECTED_SHARE = 0.05
PER_COPY = 24
GREY = slice(0, len(feature_names(PRESETS["default"].features)))  # of both; then those in colour
COLUMNS = {
    "grey": slice(0, PER_COPY),
    "scales": slice(0, 3 * PER_COPY),
    "bank": GREY,
    "bank and colour": slice(GREY.stop, None),
}


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


def both_features(images: Sequence[ByteImage]) -> FloatArray:
    """Features of the default preset without colour, then those with colour."""
    preset, shared = PRESETS["default"], {"processes": 1, "show_progress": True}
    settings = (preset.features, preset.colour_features)
    return np.hstack([shared_feature_matrix(images, of, **shared) for of in settings])


def read_grounds(folder: Path, size_px: int, store: Path) -> Grounds:
    """Compute the features of a folder of photographs, or read them from `store`."""
    file = store / f"{folder.name}_{size_px}.npz"
    if not file.exists():
        patches = load_patches(find_photos(folder), size_px)
        shared = {"processes": 1, "show_progress": True}
        plain = shared_feature_matrix(patches.images, PRESETS["chen2023"].features, **shared)
        bank = both_features(patches.images)
        names = [str(photo) for photo in patches.photos]
        store.mkdir(parents=True, exist_ok=True)
        np.savez(file, plain, bank, patches.labels, patches.groups, names)
        print(f"{folder.name}: {len(patches.too_small)} photographs smaller than {size_px} px")
    with np.load(file) as arrays:
        return Grounds(*(arrays[f"arr_{i}"] for i in range(5)))


def read_copies(folder: Path, size_px: int, store: Path) -> Grounds:
    """Compute the features of altered copies of photographs, or read them from `store`."""
    file = store / f"{folder.name}_{size_px}_copies.npz"
    if not file.exists():
        copies = load_copies(find_photos(folder), size_px, Augmentation())
        bank = both_features(copies.images)
        names = [str(photo) for photo in copies.photos]
        store.mkdir(parents=True, exist_ok=True)
        np.savez(file, bank, copies.labels, copies.groups, names)
    with np.load(file) as arrays:
        bank, labels, groups, names = (arrays[f"arr_{i}"] for i in range(4))
        return Grounds(bank[:, :PER_COPY], bank, labels, groups, names)


def lit_copies(patches: LabelledPatches, *, colour: bool) -> LabelledPatches:
    """The copies in another light that a model learns beside patches."""
    named = np.array(patches.labels), np.array(patches.groups)
    return with_other_light(LabelledPatches(), patches.images, named, colour=colour)


@dataclass(frozen=True)
class Chosen:
    """A classifier whose every choice was made on training photographs."""

    structure: str
    columns: slice
    model: Neighbours
    k: int
    rejection_distances: tuple[float, ...]
    image_rejection_distances: tuple[float, ...]
    temperature: float | None

    def probabilities(self, features: FloatArray) -> FloatArray:
        """Of each class, (n, classes)."""
        labels = self.model.labels(features[:, self.columns], self.k)
        return tempered(vote(labels, self.model.class_weights_), self.temperature)

    def distances(self, features: FloatArray) -> FloatArray:
        """To the nearest class, (n,)."""
        return self.model.distances(features[:, self.columns])

    def photo_distances(self, features: FloatArray, photos: AnyArray) -> FloatArray:
        """Distance of the patches of each photograph together, on the scale of one patch."""
        images = [np.flatnonzero(photos == photo) for photo in np.unique(photos)]
        columns = features[:, self.columns]
        _, found = self.model.labels_and_image_distances(columns, self.k, images)
        limits = self.image_rejection_distances
        pairs = zip(found.tolist(), map(len, images), strict=True)
        return np.array([as_of_one_patch(distance, count, limits) for distance, count in pairs])


def choose(
    preset: Preset,
    structures: tuple[str, ...],
    features: FloatArray,
    train: Grounds,
    copies: Grounds | None = None,
) -> Chosen:
    """Choose structure, k, temperature and rejection distances inside `train`, then learn from it.

    Of the altered copies only those of photographs in `train` are learned from.
    """
    best, best_score = None, -1.0
    for name in structures:
        columns = COLUMNS[name]
        samples = Samples(features[:, columns], train.codes, train.groups)
        altered = copies and _samples_of(copies, train, columns)
        way, found, _ = best_way(
            preset.ways,
            preset.neighbour_counts,
            samples,
            altered,
            calibrates=not preset.as_published,
        )
        score = balanced_accuracy(found.codes, found.probabilities.argmax(axis=1))
        if score > best_score:
            best, best_score = (name, columns, way, found, samples, altered), score
    name, columns, way, found, samples, altered = best
    everything = samples.with_copies(np.arange(len(samples.codes)), altered)
    limits = rejection_distances(found.distances, samples.groups[found.rows], REJECTED_SHARE)
    return Chosen(
        name,
        columns,
        way().fit(*everything),
        found.n_neighbors,
        limits[:1] if preset.as_published else limits,
        limits[:1] if preset.as_published else quantiles(found.image_distances, REJECTED_SHARE),
        found.temperature,
    )


def _samples_of(copies: Grounds, train: Grounds, columns: slice) -> Samples:
    known = copies.only(np.isin(copies.labels, train.labels))
    codes = np.searchsorted(np.unique(train.labels), known.labels)
    return Samples(known.bank[:, columns], codes, known.groups)


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
