"""Which distance detects unknown terrain best: chosen with other classes left out.

    TERRAIN_ODOMETRY_DATA=... python -m tests.studies.camera.terrain_unknown [--out FOLDER]

One class of ground/ is left out (grey, 128 px, 12 patches a photograph, two of five folds by
photograph, curved discriminants): is it farther away than held-out photographs of the others? For
each class the distance is chosen by how well it distinguishes pairs of the other classes, left out
one at a time as well, so that the class has no part in the choice. Products of powers of four
parts: the distance to the nearest samples and to the nearest mean of a class among the
discriminants, the local sparsity, and the classes that the vote of 25 neighbours leaves open.
Features are kept in --out.
"""

import argparse
import os
import tempfile
from collections.abc import Iterable
from itertools import combinations, product
from pathlib import Path

import numpy as np
from scipy.spatial.distance import cdist

from odometry.arrays import FloatArray
from terrain.classification.held_out import rejection_roc_area
from terrain.classification.neighbours.nearest import NEIGHBOURS, VOTERS, classes_left_open, nearest
from terrain.classification.neighbours.neighbours import DiscriminantNeighbours, vote
from terrain.classification.neighbours.validation import Samples, grouped_folds
from tests.studies.camera.terrain_grounds import GREY, Grounds, read_grounds

PER_PHOTO, FOLDS = 12, 2
REJECTED = 0.05  # of known patches, and of known photographs, at the limit of the last columns
SAMPLES_AND_SPARSITY = (1.0, 0.0, 1.0, 0.0)  # of version 0.11
IN_USE = (1.0, 1.0, 3.0, 1.0)
CANDIDATES = (
    SAMPLES_AND_SPARSITY,
    (1.0, 0.0, 0.0, 0.0),
    (0.0, 1.0, 0.0, 0.0),
    (0.0, 0.0, 1.0, 0.0),
    (1.0, 0.0, 1.0, 0.5),
    IN_USE,
    *((0.0, 1.0, sparsity, left_open) for sparsity, left_open in product((1.0, 2.0), (0.0, 1.0))),
    (0.0, 1.0, 1.0, 0.5),
    (0.0, 1.0, 2.0, 2.0),
)


def thinned(grounds: Grounds) -> Grounds:
    """Twelve patches of each photograph, spread evenly."""
    rows = [np.flatnonzero(grounds.photos == photo) for photo in np.unique(grounds.photos)]
    few = [of[np.linspace(0, len(of) - 1, min(len(of), PER_PHOTO)).astype(int)] for of in rows]
    return grounds.only(np.sort(np.concatenate(few)))


def parts(model: DiscriminantNeighbours, features: FloatArray) -> FloatArray:
    """Logarithms (n, 4) of what distances are made of."""
    places = model.discriminants(features)
    points, codes = model.samples()
    distances, rows = nearest(points, places, VOTERS)
    scaled = model.scaler.transform(features)
    columns = (
        distances[:, :NEIGHBOURS].mean(axis=1),
        cdist(places, model.class_means_).min(axis=1),
        model.sparsity_.sparsity(model.appearance_.transform(scaled)),
        classes_left_open(vote(codes[rows], model.class_weights_)),
    )
    return np.log(np.maximum(np.column_stack(columns), 1e-9))


def told(grounds: Grounds, left_out: Iterable[str]) -> dict[str, FloatArray]:
    """Areas and refused shares (candidates, 4) of each class that is left out, mean over folds."""
    known = grounds.only(~np.isin(grounds.labels, list(left_out)))
    found: dict[str, list[FloatArray]] = {label: [] for label in left_out}
    samples = Samples(known.bank[:, GREY], known.codes, known.groups)
    for train, test in grouped_folds(known.codes, known.groups)[:FOLDS]:
        model = DiscriminantNeighbours().fit(*samples.with_copies(train, None))
        held = known.only(test)
        near = parts(model, held.bank[:, GREY])
        for label, rows in found.items():
            unknown = grounds.only(grounds.labels == label)
            far = parts(model, unknown.bank[:, GREY])
            rows.append(np.array([scores(near @ c, held, far @ c, unknown) for c in CANDIDATES]))
    return {label: np.mean(rows, axis=0) for label, rows in found.items()}


def scores(near: FloatArray, held: Grounds, far: FloatArray, unknown: Grounds) -> list[float]:
    """Area by patch and by photograph, and what is refused where 5 % of known is."""
    by_photo = [
        np.array([np.median(of[grounds.photos == photo]) for photo in np.unique(grounds.photos)])
        for of, grounds in ((near, held), (far, unknown))
    ]
    pairs = ((near, far), tuple(by_photo))
    areas = [rejection_roc_area(*pair) for pair in pairs]
    return areas + [float(np.mean(b > np.quantile(a, 1 - REJECTED))) for a, b in pairs]


def main() -> None:
    """Print the table."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--out", type=Path, default=None, help="keep the features here")
    folder = Path(os.environ["TERRAIN_ODOMETRY_DATA"]) / "terrain-images" / "ground"
    with tempfile.TemporaryDirectory() as scratch:
        grounds = thinned(read_grounds(folder, 128, parser.parse_args().out or Path(scratch)))
    names = np.unique(grounds.labels).tolist()
    alone = {name: told(grounds, [name])[name] for name in names}
    pairs = {pair: told(grounds, pair) for pair in combinations(names, 2)}
    print("area by patch, by photograph; refused of unknown patches, photographs")
    for candidate, row in zip(CANDIDATES, np.mean(list(alone.values()), axis=0), strict=True):
        mark = {SAMPLES_AND_SPARSITY: "version 0.11", IN_USE: "in use"}.get(candidate, "")
        print(candidate, *(f"{value:.3f}" for value in row), mark)
    nested = []
    for name in names:
        others = [of[other] for pair, of in pairs.items() if name in pair
                  for other in pair if other != name]  # fmt: skip
        best = int(np.mean(others, axis=0)[:, :2].sum(axis=1).argmax())
        nested.append(alone[name][best])
        print(f"without {name:10s} chosen {CANDIDATES[best]}:",
              *(f"{value:.3f}" for value in nested[-1]), flush=True)  # fmt: skip
    print("chosen so, mean:", *(f"{value:.3f}" for value in np.mean(nested, axis=0)))


if __name__ == "__main__":
    main()
