"""Features by an image network against SFTA, on real photographs, with the same folds.

    TERRAIN_ODOMETRY_DATA=... python -m tests.studies.camera.terrain_network NETWORK.onnx
        [--layers NAME,...] [--input-range LOW:HIGH] [--per-photo PATCHES]

Five folds by photograph (photo_id), k chosen inside the training photographs; balanced accuracy by
patch and by vote of a photograph's patches, with 95 % bootstrap intervals over photographs; grey,
and colour where both cameras have it. Time of a patch on one thread.
"""

import argparse
import os
import time
from pathlib import Path

import cv2
import numpy as np

from odometry.arrays import AnyArray, FloatArray
from terrain.classification.features.feature_jobs import Transformed, features_of
from terrain.classification.features.network_features import NetworkFeatures
from terrain.classification.held_out import (
    balanced_accuracy,
    balanced_accuracy_interval,
    photo_votes,
)
from terrain.classification.neighbours.neighbours import vote
from terrain.classification.neighbours.validation import Samples, cross_validate, grouped_folds
from terrain.classification.photographs.patches import LabelledPatches, find_photos, load_patches
from terrain.classification.presets import PRESETS

PRESET = PRESETS["default"]


def answers(features: FloatArray, codes: AnyArray, groups: AnyArray) -> FloatArray:
    """Probabilities of each patch by a classifier that saw none of its photograph."""
    probabilities = np.zeros((len(codes), codes.max() + 1))
    for train, test in grouped_folds(codes, groups):
        inside = Samples(features[train], codes[train], groups[train])
        k = cross_validate(PRESET.neighbours, PRESET.neighbour_counts, inside).n_neighbors
        model = PRESET.neighbours().fit(*inside.with_copies(np.arange(len(train)), None))
        labels, _ = model.labels_and_distances(features[test], k)
        probabilities[test] = vote(labels, model.class_weights_)
    return probabilities


def scores(patches: LabelledPatches, features: FloatArray) -> str:
    """Balanced accuracy by patch and by photograph, each with its interval."""
    codes = np.unique(patches.labels, return_inverse=True)[1]
    groups, photos = np.array(patches.groups), np.array(list(map(str, patches.photos)))
    probabilities = answers(features, codes, groups)
    by_photo = photo_votes(codes, probabilities, photos)
    texts = []
    for true, said, of in (
        (codes, probabilities.argmax(axis=1), groups),
        (by_photo[0], by_photo[1], groups[by_photo[2]]),
    ):
        low, high = balanced_accuracy_interval(true, said, of, np.random.default_rng(0))
        texts.append(f"{balanced_accuracy(true, said):.3f} [{low:.3f}, {high:.3f}]")
    return "  ".join(texts)


def main() -> None:
    """Print the figures."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("network", type=Path)
    parser.add_argument("--layers", default="")
    parser.add_argument("--input-range", default="-1:1")
    parser.add_argument("--per-photo", type=int, default=60)
    arguments = parser.parse_args()
    low, high = map(float, arguments.input_range.split(":"))
    layers = tuple(filter(None, arguments.layers.split(",")))
    network = NetworkFeatures(arguments.network, layers=layers, input_range=(low, high))
    print(network.read_network().described, flush=True)
    images = Path(os.environ["TERRAIN_ODOMETRY_DATA"]) / "terrain-images"
    cv2.setNumThreads(1)
    for name, size_px, colours in (("ground", 128, (False,)), ("pavements", 96, (False, True))):
        patches = load_patches(find_photos(images / name), size_px, arguments.per_photo)
        for colour in colours:
            start_s = time.perf_counter()
            features = features_of(patches.images, Transformed(network, colour))
            each_ms = 1000 * (time.perf_counter() - start_s) / len(features)
            kind = "colour" if colour else "grey"
            print(f"{name} {size_px} px, {kind}: by patch, by photograph "
                  f"{scores(patches, features)}; {each_ms:.1f} ms a patch", flush=True)  # fmt: skip


if __name__ == "__main__":
    main()
