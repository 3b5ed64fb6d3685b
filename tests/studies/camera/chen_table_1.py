"""The confusion of Chen 2023, Table 1, on real photographs: SFTA and plain neighbours.

    TERRAIN_ODOMETRY_DATA=... python -m tests.studies.camera.chen_table_1

Nobody else has the paper's photographs. Asphalt and concrete are there with tile in place of
marble (close views), and with grass (crops of street scenes). The paper does not say what was
kept apart in its cross-validation: folds are of patches, as a plain one has them, and of
photographs. k is chosen as `train --preset chen2023` does, on the training part by photograph.
"""

import argparse
import os
from pathlib import Path

import numpy as np
from sklearn.model_selection import StratifiedKFold

from terrain.classification.features.feature_jobs import shared_feature_matrix
from terrain.classification.held_out import balanced_accuracy, confusion, confusion_text
from terrain.classification.neighbours.neighbours import vote
from terrain.classification.neighbours.validation import Samples, best_way, grouped_folds
from terrain.classification.photographs.patches import find_photos, load_patches
from terrain.classification.presets import PRESETS

CHEN = PRESETS["chen2023"]
FOLDERS = {
    "ground": (("asphalt", "concrete", "tile"), 128),
    "pavements": (("asphalt", "concrete", "grass"), 96),
}
PRINTED = {"marble": 0.987, "concrete": 0.856, "asphalt": 0.895, "grassland": 0.996}


def main() -> None:
    """Run the study and print its tables."""
    argparse.ArgumentParser(description=__doc__).parse_args()
    images = Path(os.environ["TERRAIN_ODOMETRY_DATA"]) / "terrain-images"
    print("printed:", PRINTED)
    for folder, (classes, size_px) in FOLDERS.items():
        photos = [photo for photo in find_photos(images / folder) if photo.label in classes]
        patches = load_patches(photos, size_px)
        features = shared_feature_matrix(
            patches.images, CHEN.features, processes=1, show_progress=False
        )
        codes = np.unique(patches.labels, return_inverse=True)[1]
        samples = Samples(features, codes, np.array(patches.groups))
        plain = StratifiedKFold(5, shuffle=True, random_state=0).split(features, codes)
        for name, folds in (
            ("patches", list(plain)),
            ("photographs", grouped_folds(codes, samples.groups)),
        ):
            answers = out_of_fold(samples, folds)
            print(f"\n{folder}, folds of {name}: {balanced_accuracy(codes, answers):.3f}")
            print(confusion_text(confusion(codes, answers, len(classes)), list(classes)))


def out_of_fold(samples: Samples, folds: list[tuple[np.ndarray, np.ndarray]]) -> np.ndarray:
    """Codes (n,) that each fold's classifier gives what it was not trained on."""
    answers = np.zeros_like(samples.codes)
    for train, test in folds:
        part = Samples(samples.features[train], samples.codes[train], samples.groups[train])
        way, found, _ = best_way(CHEN.ways, CHEN.neighbour_counts, part, None, calibrates=False)
        model = way().fit(part.features, part.codes)
        labels = model.labels(samples.features[test], found.n_neighbors)
        answers[test] = vote(labels, model.class_weights_).argmax(axis=1)
    return answers


if __name__ == "__main__":
    main()
