"""What the confidence of answers is learned from: images whose photograph was held out."""

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Self

import cv2
import numpy as np

from odometry.arrays import AnyArray, BoolArray, ByteImage, FloatArray, IntArray
from terrain.classification.confidence import WEIGHTS, AnswerConfidence, evidence
from terrain.classification.likeness.look import look_of, spread_rows
from terrain.classification.likeness.training_look import TrainingLook
from terrain.classification.neighbours.calibration import tempered
from terrain.classification.neighbours.neighbours import Neighbours, vote
from terrain.classification.neighbours.rejection import PATCHES, as_of_one_patch, images_of_patches
from terrain.classification.neighbours.validation import Fold, Samples
from terrain.classification.other_things import SQUARES
from terrain.classification.photographs.augmentation import Augmentation, altered
from terrain.classification.photographs.trained_on import image_sum

CROP = 4  # times as wide as a patch, at the most, of a patch beside its mirror images
NOT_KNOWN = -1
# Of scikit-image: terrain that a model of other terrains does not know
TERRAINS = ("brick", "grass", "gravel")
Table = tuple[float, FloatArray, BoolArray]


@dataclass(frozen=True)
class Shown:
    """Patches to judge: features (n, F), differences of looks (n, 11), true codes and groups (n,).

    The true code of things, and of terrain that is not known, is -1.
    """

    features: FloatArray
    differences: FloatArray
    codes: IntArray
    groups: AnyArray

    def of_groups(self, groups: AnyArray) -> Self:
        """Those of some groups."""
        rows = np.isin(self.groups, groups)
        return type(self)(
            self.features[rows], self.differences[rows], self.codes[rows], self.groups[rows]
        )


def shown_patches(
    look: TrainingLook, samples: Samples, strange: tuple[Sequence[ByteImage], FloatArray]
) -> tuple[Shown, Shown]:
    """Training patches, and every second of them altered, with their features.

    Their looks are compared with those of other photographs.
    """
    rows = spread_rows(samples.groups)
    codes, groups = samples.codes[rows], samples.groups[rows]
    of_strange = np.array([look_of(image) for image in strange[0]])
    own = groups[:, None] == groups
    return (
        Shown(samples.features[rows], look.differences(look.looks, own), codes, groups),
        Shown(strange[1], look.differences(of_strange, own[::2]), codes[::2], groups[::2]),
    )


def shown_squares(look: TrainingLook, squares: Sequence[ByteImage], features: FloatArray) -> Shown:
    """Squares by `squares_of`, none of a known terrain, with their features."""
    looks, numbers = np.array([look_of(square) for square in squares]), np.arange(len(squares))
    differences = look.differences(looks)
    return Shown(features, differences, np.full(len(numbers), NOT_KNOWN), numbers // SQUARES)


def other_terrains(known: Sequence[str]) -> tuple[str, ...]:
    """Photographs of `TERRAINS` that a model does not know by the names of its terrains."""
    names = [str(name).casefold() for name in known]
    return tuple(of for of in TERRAINS if not any(of in name for name in names))


@dataclass(frozen=True)
class Answers:
    """How a classifier answers; its neighbours, or others with the same settings."""

    model: Neighbours
    n_neighbors: int
    temperature: float | None
    limits: Sequence[float]
    look: TrainingLook

    def table(self, model: Neighbours, shown: Shown, patches: int) -> tuple[FloatArray, BoolArray]:
        """`evidence` (m, 3) of images of so many patches, and which answers are right (m,)."""
        images = images_of_patches(shown.groups, patches)
        labels, apart = model.labels_and_image_distances(shown.features, self.n_neighbors, images)
        votes = tempered(vote(labels, model.class_weights_), self.temperature)
        means = np.array([votes[rows].mean(axis=0) for rows in images])
        near = [
            as_of_one_patch(distance, len(rows), self.limits) / self.limits[0]
            for distance, rows in zip(apart.tolist(), images, strict=True)
        ]
        displaced = [self.look.displacement(shown.differences[rows]) for rows in images]
        true = np.array([shown.codes[rows[0]] for rows in images])
        given = evidence(means, np.array(near), np.array(displaced))
        return given, means.argmax(axis=1) == true


def learned_confidence(
    answers: Answers,
    folds: Sequence[Fold],
    samples: Samples,
    shown: tuple[Shown, Shown],
    not_known: Sequence[tuple[float, Shown]],
) -> AnswerConfidence | None:
    """The confidence by patches as they are and altered, each held out, and by what is not known.

    Each counts alone and with the others of its photograph; `not_known` has weights.
    """
    tables: list[Table] = []
    for _, test, model in folds:
        groups = np.unique(samples.groups[test])
        for share, kind in zip(WEIGHTS, shown, strict=False):
            held = kind.of_groups(groups)
            part = len(held.codes) / len(kind.codes)
            tables += [(share * part, *answers.table(model, held, n)) for n in _sizes(held)]
    for share, kind in not_known:
        tables += [(share, *answers.table(answers.model, kind, n)) for n in _sizes(kind)]
    return AnswerConfidence.of(tables)


def _sizes(shown: Shown) -> tuple[int, ...]:
    return (PATCHES[0], PATCHES[-1]) if len(shown.codes) else ()


def altered_patch(patch: ByteImage, *, is_to_scale: bool) -> ByteImage:
    """A patch as another camera, light or distance might show it, always the same.

    Unless the scale is known, texture becomes finer: the patch beside its mirror images is reduced.
    """
    settings = Augmentation(largest_crop=1.0 if is_to_scale else CROP)
    rng = np.random.default_rng([settings.seed, int(image_sum(patch), 16)])
    size_px = len(patch)
    border = 0 if is_to_scale else (CROP - 1) * size_px // 2
    wide = cv2.copyMakeBorder(patch, border, border, border, border, cv2.BORDER_REFLECT)
    return altered(np.asarray(wide, np.uint8), size_px, settings, rng)
