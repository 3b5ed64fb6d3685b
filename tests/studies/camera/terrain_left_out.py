"""How sure a model is of a terrain that it never saw, beside terrains that it knows.

    TERRAIN_ODOMETRY_DATA=... python -m tests.studies.camera.terrain_left_out [FOLDER...]

Each terrain of ground/ or pavements/ is left out in turn (96 px, 12 patches a photograph; the first
two of five folds by photo_id of the others): how sure are models of its photographs, and of
photographs of the others that were held out? An image is one square from the middle of a
photograph, or its middle of up to 12 squares. Printed for each: the share with a name; with a name
and a confidence of 0.8 or more, with its 95 % bootstrap interval over photographs; the same of 0.9;
of known terrain how many of those of 0.8 are wrong, and the expected calibration error of the
likeliest name, with that of exact probabilities by chance.
"""

import argparse
import os
from pathlib import Path

import numpy as np

from odometry.arrays import ByteImage
from odometry.recording.run import UNKNOWN
from terrain.classification.answer import Classification
from terrain.classification.classifier import TerrainClassifier
from terrain.classification.held_out import balanced_accuracy, balanced_accuracy_interval
from terrain.classification.neighbours.calibration import reliability, reliability_by_chance
from terrain.classification.neighbours.validation import grouped_folds
from terrain.classification.photographs.patches import LabelledPhoto, find_photos, load_patches
from terrain.images import read_image
from tests.studies.camera.terrain_confidence import likeliest

SIZE_PX, FOLDS, SURE, SURER = 96, 2, 0.8, 0.9
PARTS = {"one square": (1, 1), "up to 12 squares": (3, 4)}  # rows and columns
Answer = tuple[LabelledPhoto, Classification]


def middle(image: ByteImage, rows: int, columns: int) -> ByteImage:
    """The middle of an image, of so many squares at the most."""
    kept = []
    for length, count in zip(image.shape[:2], (rows, columns), strict=True):
        size = min(length // SIZE_PX, count) * SIZE_PX
        kept.append(slice((length - size) // 2, (length - size) // 2 + size))
    return image[kept[0], kept[1]]


def answers(
    model: TerrainClassifier, photos: list[LabelledPhoto], part: tuple[int, int]
) -> list[Answer]:
    """What a model says of the middle of each photograph."""
    images = [middle(read_image(photo.path), *part) for photo in photos]
    return list(zip(photos, model.classify(images), strict=True))


def sure_share(found: list[Answer], least: float) -> str:
    """Names of so much confidence: mean over the terrains and its interval over photographs."""
    codes = np.unique([photo.label for photo, _ in found], return_inverse=True)[1]
    sure = np.array([is_sure(answer, least) for _, answer in found])
    said = np.where(sure, codes, -1)
    groups = np.array([photo.group for photo, _ in found])
    low, high = balanced_accuracy_interval(codes, said, groups, np.random.default_rng(0))
    return f"{balanced_accuracy(codes, said):.3f} [{low:.3f}, {high:.3f}]"


def is_sure(answer: Classification, least: float) -> bool:
    """Whether it has a name with so much confidence."""
    return answer.label != UNKNOWN and answer.confidence >= least


def line(found: list[Answer]) -> str:
    """The shares with a name, and with a sure one."""
    named = np.mean([answer.label != UNKNOWN for _, answer in found])
    return f"{len(found):5d} {named:.3f} {sure_share(found, SURE)} {sure_share(found, SURER)}"


def calibration(found: list[Answer]) -> str:
    """How many sure names are wrong, and the calibration error beside that of chance."""
    right = np.array([likeliest(answer) == photo.label for photo, answer in found])
    sure = np.array([is_sure(answer, SURE) for _, answer in found])
    confidence = np.array([answer.confidence for _, answer in found])
    table = np.column_stack([confidence, np.zeros(len(found))])
    groups = np.array([photo.group for photo, _ in found])
    by_chance = reliability_by_chance(table, groups).expected_error
    measured = reliability(np.where(right, 0, 1), table)
    return (
        f"{np.mean(~right[sure]):.3f} {measured.expected_error:.3f} (chance {by_chance:.3f}), "
        f"too sure by {measured.mean_excess:.3f}"
    )


def folder_study(folder: Path) -> None:
    """Print the shares of one folder."""
    photos = find_photos(folder)
    patches = load_patches(photos, SIZE_PX, max_per_photo=12)
    labels, groups = np.array(patches.labels), np.array(patches.groups)
    known: dict[str, list[Answer]] = {name: [] for name in PARTS}
    unknown: dict[str, list[Answer]] = {name: [] for name in PARTS}
    for label in np.unique(labels):
        rows = np.flatnonzero(labels != label)
        codes = np.unique(labels[rows], return_inverse=True)[1]
        left_out = [photo for photo in photos if photo.label == label]
        for train, test in grouped_folds(codes, groups[rows])[:FOLDS]:
            images = [patches.images[i] for i in rows[train]]
            model = TerrainClassifier().fit(images, labels[rows[train]], groups[rows[train]])
            of_test = set(groups[rows[test]].tolist())
            held = [of for of in photos if of.label != label and of.group in of_test]
            for name, part in PARTS.items():
                known[name] += answers(model, held, part)
                unknown[name] += answers(model, left_out, part)
    print(f"{folder.name}: answers; with a name; sure from {SURE:g}, from {SURER:g};")
    print("of known ones: wrong of the sure, calibration error")
    for name in PARTS:
        print(f"  {name}, known   ", line(known[name]), calibration(known[name]))
        print(f"  {name}, left out", line(unknown[name]))
        for label in np.unique(labels):
            print(f"    {label:14s}", line([of for of in unknown[name] if of[0].label == label]))


def main() -> None:
    """Print the shares."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("folders", nargs="*", choices=[[], "ground", "pavements"], default=[])
    root = Path(os.environ["TERRAIN_ODOMETRY_DATA"]) / "terrain-images"
    for name in parser.parse_args().folders or ("ground", "pavements"):
        folder_study(root / name)


if __name__ == "__main__":
    main()
