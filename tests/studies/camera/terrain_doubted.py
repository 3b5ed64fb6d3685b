"""What is lost and gained where a model would not notice another camera and doubts names.

    TERRAIN_ODOMETRY_DATA=... python -m tests.studies.camera.terrain_doubted [--colour]
        [--classes A,B]

Models of pavements/ (96 px, 12 patches a photograph, five folds by photo_id; then each terrain left
out in turn) answer the middle of photographs, up to 12 squares: those held out, as they are and as
another camera shows them, photographs of the terrain that was left out, and of ground/. Printed are
shares of right and of wrong names, and of names right or refused with its 95 % bootstrap interval
over photo_ids, as if the camera were that of training, then as `classify` answers.
"""

import argparse
import os
from collections.abc import Callable, Sequence
from pathlib import Path
from typing import NamedTuple

import cv2
import numpy as np

from odometry.arrays import ByteImage, FloatArray
from odometry.recording.run import UNKNOWN
from terrain.classification.classifier import TerrainClassifier
from terrain.classification.neighbours.validation import grouped_folds
from terrain.classification.photographs.patches import LabelledPhoto, find_photos, load_patches
from terrain.images import read_image
from tests.studies.camera.terrain_left_out import SIZE_PX, middle
from tests.studies.camera.terrain_likeness import blurred, compressed, gamma, times

Change = Callable[[ByteImage, np.random.Generator], ByteImage]


def as_it_is(image: ByteImage, _: np.random.Generator) -> ByteImage:
    """The photograph itself."""
    return image


def by_a_camera(image: ByteImage, rng: np.random.Generator) -> ByteImage:
    """Scale, focus, curve, contrast, light, white balance, saturation, noise and JPEG, drawn."""
    image = scaled(image, float(np.exp(rng.uniform(-np.log(3), np.log(2)))))
    if rng.uniform() < 0.5:
        image = blurred(0.3 + 1.2 * rng.uniform())(image)
    shown = 255 * (image / 255.0) ** (1.8 ** rng.uniform(-1, 1))
    grey = shown.mean()
    shown = grey + 1.5 ** rng.uniform(-1, 1) * (shown - grey) + rng.uniform(-25, 25)
    red, blue = 1.25 ** rng.uniform(-1, 1, 2)
    shown = shown * np.array([red, 1, blue])
    greys = shown.mean(axis=2, keepdims=True)
    shown = greys + 1.5 ** rng.uniform(-1, 1) * (shown - greys)
    shown += 6 * rng.uniform() ** 2 * rng.standard_normal(shown.shape)
    return compressed(int(rng.integers(30, 96)))(np.clip(np.rint(shown), 0, 255).astype(np.uint8))


def scaled(image: ByteImage, factor: float) -> ByteImage:
    """Larger or smaller, but no smaller than a square."""
    by = max(factor, (SIZE_PX + 0.5) / min(image.shape[:2]))
    how = cv2.INTER_AREA if by < 1 else cv2.INTER_CUBIC
    return np.asarray(cv2.resize(image, None, fx=by, fy=by, interpolation=how), np.uint8)


CHANGES: dict[str, Change] = {
    "as they are": as_it_is,
    "by a camera": by_a_camera,
    "cast 1.25, 1, 0.75": lambda image, _: times(1.25, 1, 0.75)(image),
    "half the scale": lambda image, _: scaled(image, 0.5),
    "gamma 1.8": lambda image, _: gamma(1.8)(image),
    "blur of 1.3 px": lambda image, _: blurred(1.3)(image),
}


class Row(NamedTuple):
    """Of a photograph: its photo_id, and the right and wrong names of both ways (0 or 1)."""

    group: str
    right_same: bool
    wrong_same: bool
    right: bool
    wrong: bool


def rows(model: TerrainClassifier, photos: Sequence[LabelledPhoto], change: Change) -> list[Row]:
    """What a model says of photographs, all together, as if of its camera and as it answers."""
    images = []
    for place, photo in enumerate(photos):
        read = read_image(photo.path)
        coloured = read if read.ndim == 3 else np.repeat(read[..., None], 3, axis=2)
        shown = change(middle(coloured, 3, 4), np.random.default_rng([2, place]))
        images.append(middle(shown, 3, 4))
    likeness = model.likeness(images)
    found = []
    for photo, answer in zip(photos, model.classify(images), strict=True):
        cells = []
        for share in (None, model.noticed_share_):
            label = answer.unless_doubtful(likeness, share).label
            cells += [label == photo.label, label not in {photo.label, UNKNOWN}]
        found.append(Row(photo.group, *cells))
    return found


def line(found: Sequence[Row]) -> str:
    """Shares of both ways, and the intervals of what is right or refused."""
    table = np.array([row[1:] for row in found], float)
    groups = np.unique([row.group for row in found], return_inverse=True)[1]
    low, high = np.quantile(1 - _drawn(table, groups)[..., [1, 3]], [0.025, 0.975], axis=0)
    right_same, wrong_same, right, wrong = table.mean(axis=0)
    return (
        f"{len(table):5d} right {right_same:.3f} -> {right:.3f}, wrong {wrong_same:.3f} -> "
        f"{wrong:.3f}; right or refused {1 - wrong_same:.3f} [{low[0]:.3f}, {high[0]:.3f}] -> "
        f"{1 - wrong:.3f} [{low[1]:.3f}, {high[1]:.3f}]"
    )


def _drawn(table: FloatArray, groups: FloatArray) -> FloatArray:
    """Shares (2000, 4) of groups drawn with replacement."""
    sums = np.array([table[groups == group].sum(axis=0) for group in np.unique(groups)])
    sizes = np.bincount(groups)
    drawn = np.random.default_rng(0).multinomial(len(sizes), [1 / len(sizes)] * len(sizes), 2000)
    return np.asarray((drawn @ sums) / (drawn @ sizes)[:, None])


def main() -> None:
    """Print the shares."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--colour", action="store_true")
    parser.add_argument("--classes", type=lambda text: text.split(","), default=None)
    arguments = parser.parse_args()
    root = Path(os.environ["TERRAIN_ODOMETRY_DATA"]) / "terrain-images"
    every, other = find_photos(root / "pavements"), find_photos(root / "ground")
    photos = [of for of in every if not arguments.classes or of.label in arguments.classes]
    patches = load_patches(photos, SIZE_PX, max_per_photo=12)
    labels, groups = np.array(patches.labels), np.array(patches.groups)
    found: dict[str, list[Row]] = {}

    def fitted(train: FloatArray) -> TerrainClassifier:
        model = TerrainClassifier(colour=arguments.colour)
        return model.fit([patches.images[i] for i in train], labels[train], groups[train])

    for train, test in grouped_folds(np.unique(labels, return_inverse=True)[1], groups):
        model, held = fitted(train), set(groups[test].tolist())
        for name, change in CHANGES.items():
            shown = rows(model, [of for of in photos if of.group in held], change)
            found.setdefault(f"held out, {name}", []).extend(shown)
        found.setdefault("ground/", []).extend(rows(model, other, as_it_is))
        print(f"a model that notices {model.noticed_share_}", flush=True)
    for label in np.unique(labels) if len(np.unique(labels)) > 2 else ():
        model = fitted(np.flatnonzero(labels != label))
        for name in list(CHANGES)[:2]:
            shown = rows(model, [of for of in photos if of.label == label], CHANGES[name])
            found.setdefault(f"left out, {name}", []).extend(shown)
    for name, of in found.items():
        print(f"{name:30s}", line(of), flush=True)


if __name__ == "__main__":
    main()
