"""How sure a model of two or three terrains is of terrain that it does not know.

    TERRAIN_ODOMETRY_DATA=... python -m tests.studies.camera.terrain_few [--known 3]
        [--part held-out]

Models of two terrains of ground/ or pavements/ (96 px, 12 patches a photograph; the first two of
five folds by photo_id) answer photographs that were held out, and those of all other terrains. The
pairs of a folder are parted at random: choices were made on those of development. Of three terrains
there are twelve of each folder, none of development. Printed for one square from the middle of a
photograph, and for its middle of up to 12 squares: the share of known photographs with the right
name and a confidence of 0.8 or more, with a wrong one, with the right name; that of others with a
name of 0.8 or more, and `unknown`; each with its 95 % bootstrap interval over photographs.
"""

import argparse
import os
from itertools import combinations
from pathlib import Path

import numpy as np

from odometry.arrays import AnyArray, BoolArray
from odometry.recording.run import UNKNOWN
from terrain.classification.classifier import TerrainClassifier
from terrain.classification.neighbours.validation import grouped_folds
from terrain.classification.photographs.patches import find_photos, load_patches
from tests.studies.camera.terrain_left_out import (
    FOLDS,
    PARTS,
    SIZE_PX,
    SURE,
    Answer,
    answers,
    is_sure,
)

DEVELOPMENT, HELD_OUT = "development", "held-out"
TRIPLES, DRAWS = 12, 500


def chosen(terrains: list[str], known: int, part: str) -> list[tuple[str, ...]]:
    """The models of a folder: terrains of each."""
    every = list(combinations(terrains, known))
    if known > 2:
        order = np.random.default_rng(5).permutation(len(every))
        return [every[i] for i in order[:TRIPLES]]
    order, half = np.random.default_rng(11).permutation(len(every)), (len(every) + 1) // 2
    return [every[i] for i in sorted(order[:half] if part == DEVELOPMENT else order[half:])]


def share(of: BoolArray, groups: AnyArray) -> str:
    """The share of answers (n,), with its interval over photographs."""
    codes = np.unique(groups, return_inverse=True)[1]
    hits, counts = np.bincount(codes, of), np.bincount(codes)
    drawn = np.random.default_rng(0).integers(0, len(counts), (DRAWS, len(counts)))
    low, high = np.quantile(hits[drawn].sum(axis=1) / counts[drawn].sum(axis=1), [0.025, 0.975])
    return f"{of.sum()} of {len(of)}, {of.mean():.3f} [{low:.3f}, {high:.3f}]"


def table(known: list[Answer], others: list[Answer]) -> None:
    """Print the shares."""
    for name, found in (("known", known), ("others", others)):
        groups = np.array([photo.group for photo, _ in found])
        right = np.array([answer.label == photo.label for photo, answer in found])
        sure = np.array([is_sure(answer, SURE) for _, answer in found])
        refused = np.array([answer.label == UNKNOWN for _, answer in found])
        for words, of in {
            "sure and right": sure & right,
            "sure and wrong": sure & ~right,
            "right": right,
            "unknown": refused,
        }.items():
            print(f"    {name}, {words}: {share(of, groups)}")


def folder_study(folder: Path, known: int, part: str) -> None:
    """Print the shares of one folder."""
    photos = find_photos(folder)
    patches = load_patches(photos, SIZE_PX, max_per_photo=12)
    labels, groups = np.array(patches.labels), np.array(patches.groups)
    found: dict[str, tuple[list[Answer], list[Answer]]] = {name: ([], []) for name in PARTS}
    for names in chosen(sorted(set(patches.labels)), known, part):
        rows = np.flatnonzero(np.isin(labels, names))
        codes = np.unique(labels[rows], return_inverse=True)[1]
        others = [photo for photo in photos if photo.label not in names]
        for train, test in grouped_folds(codes, groups[rows])[:FOLDS]:
            images = [patches.images[i] for i in rows[train]]
            model = TerrainClassifier().fit(images, labels[rows[train]], groups[rows[train]])
            of_test = set(groups[rows[test]].tolist())
            held = [photo for photo in photos if photo.label in names and photo.group in of_test]
            for name, size in PARTS.items():
                found[name][0].extend(answers(model, held, size))
                found[name][1].extend(answers(model, others, size))
    for name in PARTS:
        print(f"{folder.name}, {known} terrains, {name}")
        table(*found[name])


def main() -> None:
    """Print the shares."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--known", type=int, choices=[2, 3], default=2)
    parser.add_argument("--part", choices=[DEVELOPMENT, HELD_OUT], default=HELD_OUT)
    given = parser.parse_args()
    root = Path(os.environ["TERRAIN_ODOMETRY_DATA"]) / "terrain-images"
    for name in ("ground", "pavements"):
        folder_study(root / name, given.known, given.part)


if __name__ == "__main__":
    main()
