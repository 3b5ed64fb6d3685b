"""Whether a model notices images that are unlike its training photographs, and its false alarms.

    TERRAIN_ODOMETRY_DATA=... python -m tests.studies.camera.terrain_likeness

A run is twelve squares at random, up to four of a photograph, of one terrain or of all. The own
camera: photographs of ground/ and pavements/ that were held out (five folds by photo_id), as they
are and altered; beside the share of runs with the note stands what the change costs: balanced
accuracy of the squares, and of those with a name how many are right. Another camera: pavements/
before a model of ground/, and the lower halves of camera-frames/.
"""

import argparse
import os
from collections.abc import Callable
from dataclasses import dataclass
from pathlib import Path

import cv2
import numpy as np

from odometry.arrays import AnyArray, ByteImage, FloatArray
from terrain.classification.classifier import TerrainClassifier
from terrain.classification.held_out import balanced_accuracy
from terrain.classification.likeness.look import look_of
from terrain.classification.likeness.training_look import TrainingLook
from terrain.classification.neighbours.validation import grouped_folds
from terrain.classification.photographs.patches import cut_patches, find_photos, load_patches
from terrain.images import read_image

SIZE_PX, SQUARES, RUN, RUNS = 96, 4, 12, 100
Change = Callable[[ByteImage], ByteImage]


def gamma(power: float) -> Change:
    """Another exposure: each channel to a power."""
    table = np.rint(255 * (np.arange(256) / 255) ** power).astype(np.uint8)
    return lambda image: table[image]


def times(*factors: float) -> Change:
    """A colour cast."""
    return lambda image: np.clip(image * np.array(factors), 0, 255).astype(np.uint8)


def blurred(sigma_px: float) -> Change:
    """Out of focus."""
    return lambda image: cv2.GaussianBlur(image, (0, 0), sigma_px)


def compressed(quality: int) -> Change:
    """JPEG once more."""

    def change(image: ByteImage) -> ByteImage:
        _, coded = cv2.imencode(".jpg", image[..., ::-1], [cv2.IMWRITE_JPEG_QUALITY, quality])
        return np.asarray(cv2.imdecode(coded, cv2.IMREAD_COLOR)[..., ::-1], np.uint8)

    return change


def noisy(image: ByteImage) -> ByteImage:
    """Noise of 10 grey levels."""
    noise = np.random.default_rng(0).normal(0, 10, (*image.shape[:2], 1))
    return np.clip(image + noise, 0, 255).astype(np.uint8)


ALTERED: dict[str, Change] = {
    "own camera": lambda image: image,
    "blur of 1 px": blurred(1),
    "blur of 3 px": blurred(3),
    "gamma 0.5": gamma(0.5),
    "gamma 0.7": gamma(0.7),
    "gamma 2": gamma(2.0),
    "JPEG of quality 10": compressed(10),
    "JPEG of quality 30": compressed(30),
    "cast 1.3, 1, 0.7": times(1.3, 1.0, 0.7),
    "cast 0.8, 1, 1.2": times(0.8, 1.0, 1.2),
    "a quarter of the scale": lambda image: cv2.resize(
        image, None, fx=0.25, fy=0.25, interpolation=cv2.INTER_AREA
    ),
    "noise of 10 levels": noisy,
}


@dataclass(frozen=True)
class Squares:
    """Squares of photographs, their looks (n, 7), terrains and photo_ids."""

    images: list[ByteImage]
    looks: FloatArray
    labels: AnyArray
    groups: AnyArray

    @classmethod
    def of(cls, folder: Path, change: Change) -> "Squares":
        """Up to four of every photograph, changed."""
        images, names = [], []
        for photo in find_photos(folder):
            read = read_image(photo.path)
            coloured = read if read.ndim == 3 else np.repeat(read[..., None], 3, axis=2)
            squares = cut_patches(change(coloured), SIZE_PX)
            kept = np.linspace(0, len(squares) - 1, min(len(squares), SQUARES)).astype(int)
            images += [squares[i] for i in kept]
            names += [(photo.label, photo.group) for _ in kept]
        labels, groups = map(np.array, zip(*names, strict=True))
        return cls(images, np.array([look_of(image) for image in images]), labels, groups)

    def only(self, rows: AnyArray) -> "Squares":
        """Some of them."""
        images = [self.images[i] for i in rows]
        return Squares(images, self.looks[rows], self.labels[rows], self.groups[rows])

    def noted(self, training: TrainingLook, terrains: list[str], rng: np.random.Generator) -> float:
        """Share of runs over some of the terrains that get the note."""
        rows = np.flatnonzero(np.isin(self.labels, terrains))
        size = min(RUN, len(rows))
        runs = [rng.choice(rows, size, replace=False) for _ in range(RUNS)]
        return float(np.mean([bool(training.compared(self.looks[run]).is_unlike) for run in runs]))

    def shares(self, training: TrainingLook, rng: np.random.Generator) -> list[float]:
        """Runs with the note: over all terrains, over one (the mean, the worst)."""
        names = sorted(set(self.labels.tolist()))
        alone = [self.noted(training, [name], rng) for name in names]
        return [self.noted(training, names, rng), float(np.mean(alone)), max(alone)]


def own_camera(folder: Path) -> list[TerrainClassifier]:
    """Print notes and accuracy on photographs held out; the models of the folds."""
    patches = load_patches(find_photos(folder), SIZE_PX, max_per_photo=12)
    labels, groups = np.array(patches.labels), np.array(patches.groups)
    folds = grouped_folds(np.unique(labels, return_inverse=True)[1], groups)
    models = [
        TerrainClassifier().fit([patches.images[i] for i in train], labels[train], groups[train])
        for train, _ in folds
    ]
    print(f"{folder.name}: runs with the note over all terrains, over one (mean, worst); balanced")
    print("accuracy of squares; share with a name; of those right")
    for name, change in ALTERED.items():
        every, rows = Squares.of(folder, change), []
        for (_, test), model in zip(folds, models, strict=True):
            held = every.only(np.flatnonzero(np.isin(every.groups, groups[test])))
            answers = model.classify(held.images)
            best = np.array([max(of.probabilities, key=of.probabilities.get) for of in answers])
            named = np.array([of.label != "unknown" for of in answers])
            accuracy = balanced_accuracy(held.labels, best)
            right = (best == held.labels)[named].mean() if named.any() else np.nan
            shares = held.shares(model.training_look_, np.random.default_rng(1))
            rows.append([*shares, accuracy, named.mean(), right])
        print(f"  {name:24s}", *(f"{cell:.2f}" for cell in np.nanmean(rows, axis=0)), flush=True)
    return models


def main() -> None:
    """Print the shares."""
    argparse.ArgumentParser(description=__doc__).parse_args()
    root = Path(os.environ["TERRAIN_ODOMETRY_DATA"])
    looks = [model.training_look_ for model in own_camera(root / "terrain-images" / "ground")]
    own_camera(root / "terrain-images" / "pavements")
    other = Squares.of(root / "terrain-images" / "pavements", ALTERED["own camera"])
    found = np.mean([other.shares(look, np.random.default_rng(1)) for look in looks], axis=0)
    print("pavements before models of ground:", *(f"{cell:.2f}" for cell in found))
    for file in sorted((root / "camera-frames").glob("*/*.jpg")):
        image = read_image(file)
        squares = cut_patches(image[len(image) // 2 :], SIZE_PX)
        of = looks[0].compared(np.array([look_of(square) for square in squares]))
        ranks = f"{of.rank:.2f}, {of.rank_in_class:.2f}, {of.exposure:.2f}"
        print(f"{file.parent.name} {file.stem}: {of.is_unlike}, ranks {ranks}, {of.how}")


if __name__ == "__main__":
    main()
