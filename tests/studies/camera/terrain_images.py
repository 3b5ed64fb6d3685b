"""The terrain classifiers on real photographs: confusion, a new camera, unknown terrain.

    TERRAIN_ODOMETRY_DATA=... python -m tests.studies.camera.terrain_images [--out FOLDER]

Patches overlap by half, at most 60 a photograph, as `train` cuts them. All folds keep photographs
(photo_id) whole. In each outer fold the structure (which copies of the image), k and the rejection
distance are chosen by cross-validation inside the training photographs alone; the candidates are
columns of one feature matrix, so the features are computed once. Features are kept in --out.
"""

import argparse
import os
import tempfile
from collections import Counter
from pathlib import Path

import numpy as np

from odometry.arrays import AnyArray, FloatArray, IntArray
from terrain.classification.held_out import (
    balanced_accuracy,
    balanced_accuracy_interval,
    confusion,
    confusion_text,
    photo_votes,
    rejection_roc_area,
)
from terrain.classification.neighbours.validation import grouped_folds
from terrain.classification.presets import PRESETS
from tests.studies.camera.terrain_grounds import Grounds, Way, choose, joined, read_grounds

NEW_CAMERA_DRAWS = 5

CHEN = Way("chen2023", PRESETS["chen2023"], ("grey",))
GREY = Way("default", PRESETS["default"], ("grey", "scales", "bank"))
COLOUR = Way("default, colour allowed", PRESETS["default"], (*GREY.structures, "bank and colour"))


def confusions(grounds: Grounds, way: Way) -> None:
    """Print accuracies with intervals, what the folds chose, and the confusion."""
    codes, classes = grounds.codes, np.unique(grounds.labels)
    features = way.features(grounds)
    probabilities = np.zeros((len(codes), len(classes)))
    chosen = []
    for train, test in grouped_folds(codes, grounds.groups):
        model = choose(way.preset, way.structures, features[train], grounds.only(train))
        probabilities[test] = model.probabilities(features[test])
        chosen.append(f"{model.structure}, k {model.k}")
    answers = probabilities.argmax(axis=1)
    photo_codes, photo_answers, rows = photo_votes(codes, probabilities, grounds.photos)
    print(f"{way.name}: chosen in the folds: {dict(Counter(chosen))}")
    print(f"  by patch {scored(codes, answers, grounds.groups)}")
    print(f"  by vote  {scored(photo_codes, photo_answers, grounds.groups[rows])}")
    print(confusion_text(confusion(codes, answers, len(classes)), list(classes)), flush=True)


def scored(codes: IntArray, answers: IntArray, groups: AnyArray) -> str:
    """Balanced accuracy with its interval."""
    interval = balanced_accuracy_interval(codes, answers, groups, np.random.default_rng(0))
    return f"{balanced_accuracy(codes, answers):.3f} [{interval[0]:.3f}, {interval[1]:.3f}]"


def new_camera(old: Grounds, new: Grounds, way: Way) -> None:
    """Train on one folder with a few photographs of another, test on the rest of the other."""
    common = np.intersect1d(old.labels, new.labels)
    old, new = (g.only(np.isin(g.labels, common)) for g in (old, new))
    print(f"{way.name}: {', '.join(common)}")
    for n_photos in (0, 3, 10):
        mixed, alone = [], []
        for seed in range(NEW_CAMERA_DRAWS if n_photos else 1):
            shown = draw_photos(new, n_photos, np.random.default_rng(seed))
            rest = new.only(~shown)
            both = joined(old, new.only(shown))
            mixed.append(patch_accuracy(way, both, rest))
            if n_photos:
                alone.append(patch_accuracy(way, new.only(shown), rest))
        line = f"  {n_photos:2d} new photographs a class: with the old {np.mean(mixed):.3f}"
        print(line + (f", without the old {np.mean(alone):.3f}" if alone else ""), flush=True)


def draw_photos(grounds: Grounds, n_photos: int, rng: np.random.Generator) -> AnyArray:
    """Mark the patches of some photographs of each class, whole photo_ids."""
    drawn = [
        rng.choice(np.unique(grounds.groups[grounds.labels == label]), n_photos, replace=False)
        for label in np.unique(grounds.labels)
    ]
    return np.isin(grounds.groups, np.concatenate(drawn))


def patch_accuracy(way: Way, train: Grounds, test: Grounds) -> float:
    """Balanced accuracy by patch, the preset's own structure, k chosen on `train`."""
    model = choose(way.preset, way.structures[-1:], way.features(train), train)
    return balanced_accuracy(test.codes, model.probabilities(way.features(test)).argmax(axis=1))


def unknown_terrain(grounds: Grounds, way: Way) -> None:
    """Leave one class out: is it farther away than held-out photographs of the others?"""
    print(f"{way.name}: ROC area by patch, by photograph; rejected of unknown, of known")
    table = []
    for label in np.unique(grounds.labels):
        known, unknown = (
            grounds.only(m) for m in (grounds.labels != label, grounds.labels == label)
        )
        rows = []
        for train, test in grouped_folds(known.codes, known.groups):
            part, held = known.only(train), known.only(test)
            model = choose(way.preset, way.structures[-1:], way.features(part), part)
            near, far = (model.distances(way.features(g)) for g in (held, unknown))
            rows.append(
                (
                    rejection_roc_area(near, far),
                    rejection_roc_area(by_photo(near, held), by_photo(far, unknown)),
                    np.mean(far > model.rejection_distances[0]),
                    np.mean(near > model.rejection_distances[0]),
                )
            )
        table.append(np.mean(rows, axis=0))
        print(f"  without {label:14s}", *(f"{value:6.3f}" for value in table[-1]), flush=True)
    print("  mean                  ", *(f"{value:6.3f}" for value in np.mean(table, axis=0)))


def by_photo(distances: FloatArray, grounds: Grounds) -> FloatArray:
    """Median distance of each photograph's patches."""
    return np.array(
        [np.median(distances[grounds.photos == photo]) for photo in np.unique(grounds.photos)]
    )


def main() -> None:
    """Run the study and print its figures."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--out", type=Path, default=None, help="keep the features here")
    arguments = parser.parse_args()
    images = Path(os.environ["TERRAIN_ODOMETRY_DATA"]) / "terrain-images"
    with tempfile.TemporaryDirectory() as scratch:
        study(images, arguments.out or Path(scratch))


def study(images: Path, store: Path) -> None:
    """Print every figure."""
    ground = read_grounds(images / "ground", 128, store)
    pavements = read_grounds(images / "pavements", 96, store)
    small_ground = read_grounds(images / "ground", 96, store)
    for name, grounds, ways in (
        ("ground, 128 px", ground, (CHEN, GREY)),
        ("pavements, 96 px", pavements, (CHEN, GREY, COLOUR)),
    ):
        print(f"\n== {name}: {len(grounds.labels)} patches, balanced accuracy [95 % interval]")
        for way in ways:
            confusions(grounds, way)
    print("\n== from ground to pavements, 96 px, balanced accuracy by patch")
    for way in (CHEN, GREY):
        new_camera(small_ground, pavements, way)
    for name, grounds in (("ground", ground), ("pavements", pavements)):
        print(f"\n== unknown terrain, {name}")
        for way in (CHEN, GREY):
            unknown_terrain(grounds, way)


if __name__ == "__main__":
    main()
