"""Unknown terrain by several patches of a photograph: by the median of distances, or together.

    TERRAIN_ODOMETRY_DATA=... python -m tests.studies.camera.terrain_unknown_images [--out FOLDER]

One class is left out in turn: is it farther away than held-out photographs of the others? All five
folds by photograph, grey, 12 patches a photograph in training and 1, 2, 4 or 12 in use, on ground/
(128 px) and pavements/ (96 px): area under the ROC curve by photograph, and what is refused of
unknown where 5 % of held-out known is. Beside the two stands the distance of version 0.4 (nearest
samples among linear discriminants, times sparsity; the median). Features are kept in --out.
"""

import argparse
import os
import tempfile
from pathlib import Path

import numpy as np

from odometry.arrays import FloatArray, IntArray
from terrain.classification.held_out import rejection_roc_area
from terrain.classification.neighbours.neighbours import DiscriminantNeighbours
from terrain.classification.neighbours.validation import Samples, grouped_folds
from terrain.classification.presets import linear_neighbours
from tests.studies.camera.terrain_grounds import GREY, Grounds, read_grounds
from tests.studies.camera.terrain_unknown import FOLDS as FEWER_FOLDS
from tests.studies.camera.terrain_unknown import REJECTED, parts, thinned

PATCHES = (1, 2, 4, 12)
WAYS = ("version 0.4, median", "in use, median", "in use, together")
Distances = dict[tuple[int, str], FloatArray]


def images_of(grounds: Grounds, count: int) -> list[IntArray]:
    """Rows of so many patches of each photograph, spread evenly."""
    rows = [np.flatnonzero(grounds.photos == photo) for photo in np.unique(grounds.photos)]
    return [of[np.linspace(0, len(of) - 1, min(count, len(of))).astype(int)] for of in rows]


def distances(
    old: DiscriminantNeighbours, new: DiscriminantNeighbours, grounds: Grounds
) -> Distances:
    """Of each photograph by each way and number of patches."""
    features = grounds.bank[:, GREY]
    by_patch = {
        WAYS[0]: np.exp(parts(old, features)[:, [0, 2]].sum(axis=1)),
        WAYS[1]: new.distances(features),
    }
    found: Distances = {}
    for count in PATCHES:
        images = images_of(grounds, count)
        for way, of in by_patch.items():
            found[count, way] = np.array([np.median(of[rows]) for rows in images])
        found[count, WAYS[2]] = new.labels_and_image_distances(features, 1, images)[1]
    return found


def judged(grounds: Grounds, name: str, fold: int) -> dict[tuple[int, str], tuple[float, float]]:
    """Area and refused share without one class, in one fold."""
    known, unknown = (grounds.only(of) for of in (grounds.labels != name, grounds.labels == name))
    train, test = grouped_folds(known.codes, known.groups)[fold]
    samples = Samples(known.bank[:, GREY], known.codes, known.groups)
    learned = samples.with_copies(train, None)
    models = linear_neighbours().fit(*learned), DiscriminantNeighbours().fit(*learned)
    near, far = (distances(*models, of) for of in (known.only(test), unknown))
    return {
        key: (
            rejection_roc_area(near[key], far[key]),
            float(np.mean(far[key] > np.quantile(near[key], 1 - REJECTED))),
        )
        for key in near
    }


def main() -> None:
    """Print the tables."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--out", type=Path, default=None, help="keep the features here")
    out = parser.parse_args().out
    images = Path(os.environ["TERRAIN_ODOMETRY_DATA"]) / "terrain-images"
    for folder, size_px in (("ground", 128), ("pavements", 96)):
        with tempfile.TemporaryDirectory() as scratch:
            grounds = thinned(read_grounds(images / folder, size_px, out or Path(scratch)))
        names = np.unique(grounds.labels).tolist()
        folds = [[judged(grounds, name, fold) for name in names] for fold in range(5)]
        print(f"{folder}: area, refused of unknown; the same of the first {FEWER_FOLDS} folds")
        for key in folds[0][0]:
            means = np.array([[of[key] for of in fold] for fold in folds]).mean(axis=1)
            cells = (*means.mean(axis=0), *means[:FEWER_FOLDS].mean(axis=0))
            print(f"{key[0]:3d} patches, {key[1]:20s}", *(f"{cell:.3f}" for cell in cells))


if __name__ == "__main__":
    main()
