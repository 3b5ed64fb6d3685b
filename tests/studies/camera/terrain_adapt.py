"""A few labelled photographs of a new camera: alone, mixed with the old, or the old model as it is.

    TERRAIN_ODOMETRY_DATA=... python -m tests.studies.camera.terrain_adapt [--draws N]
        [--out FOLDER]

From ground/ to pavements/ (four shared terrains, squares of 96 px): 1, 3 and 10 photographs a
terrain of pavements/ are drawn, each draw with its own seed; balanced accuracy by patch on all
others. `train --adapt` decides by cross-validation inside the drawn photographs which of the three
to keep; the last column is what it kept, its score, and how often. In colour the old photographs
are grey: only what is learned of the new ones alone has colour. New photographs have copies in
another light beside them. Features are kept in --out.
"""

import argparse
import os
import tempfile
from collections import Counter
from pathlib import Path

import numpy as np

from odometry.arrays import BoolArray, FloatArray, IntArray
from terrain.classification.adaptation import ALONE, MIXED, OLD, clearly_best
from terrain.classification.features.feature_jobs import shared_feature_matrix
from terrain.classification.held_out import balanced_accuracy
from terrain.classification.neighbours.neighbours import Neighbours, vote
from terrain.classification.neighbours.validation import Samples, cross_validate
from terrain.classification.old_samples import SamplesBesideOld
from terrain.classification.photographs.patches import find_photos, load_patches
from terrain.classification.presets import PRESETS
from tests.studies.camera.terrain_grounds import COLUMNS, GREY, Grounds, both_features, lit_copies

PRESET = PRESETS["default"]
COLOUR = COLUMNS["bank and colour"]
SIZE_PX, PER_PHOTO, PER_OLD_PHOTO = 96, 60, 12


def read(folder: Path, per_photo: int, store: Path) -> Grounds:
    """Features of a folder of photographs, computed or read from `store`."""
    file = store / f"{folder.name}_{SIZE_PX}_{per_photo}.npz"
    if not file.exists():
        patches = load_patches(find_photos(folder), SIZE_PX, per_photo)
        bank = both_features(patches.images)
        names = [str(photo) for photo in patches.photos]
        store.mkdir(parents=True, exist_ok=True)
        np.savez(file, bank[:, :0], bank, patches.labels, patches.groups, names)
    with np.load(file) as arrays:
        return Grounds(*(arrays[f"arr_{i}"] for i in range(5)))


def read_copies(folder: Path, columns: slice, store: Path) -> Grounds:
    """Features of the copies in another light that a model learns from, in grey or in colour."""
    colour = columns is COLOUR
    file = store / f"{folder.name}_{SIZE_PX}_copies_{'colour' if colour else 'grey'}.npz"
    if not file.exists():
        copies = lit_copies(load_patches(find_photos(folder), SIZE_PX, PER_PHOTO), colour=colour)
        settings = PRESET.colour_features if colour else PRESET.features
        made = shared_feature_matrix(copies.images, settings, processes=1)
        np.savez(file, made, copies.labels, copies.groups)
    with np.load(file) as arrays:
        made, labels, groups = (arrays[f"arr_{i}"] for i in range(3))
        return Grounds(made[:, :0], made, labels, groups, groups)


def learned(
    samples: Samples, copies: Samples | None = None, *, judged: bool
) -> tuple[Neighbours, int, BoolArray]:
    """Neighbours, k and which held-out patches (n,) are named rightly, where some could be."""
    right, k = np.zeros(0, dtype=bool), PRESET.neighbour_counts[0]
    if judged:
        found = cross_validate(
            PRESET.neighbours, PRESET.neighbour_counts, samples, copies, calibrates=True
        )
        right = found.probabilities.argmax(axis=1) == found.codes
        k = found.n_neighbors
    everything = samples.with_copies(np.arange(len(samples.codes)), copies)
    return PRESET.neighbours().fit(*everything), k, right


def answers(model: Neighbours, k: int, features: FloatArray) -> IntArray:
    """The likeliest class of each patch."""
    labels, _ = model.labels_and_distances(features, k)
    return vote(labels, model.class_weights_).argmax(axis=1)


def one_draw(
    old: Grounds,
    as_it_is: tuple[Neighbours, int],
    all_new: tuple[Grounds, Samples, Samples],
    photos: int,
    seed: int,
) -> tuple[dict[str, float], str, float]:
    """Accuracy of each way on the photographs that were not drawn; what is kept, and colour's."""
    new, in_grey, in_colour = all_new
    rng = np.random.default_rng(seed)
    drawn = [
        rng.choice(np.unique(new.groups[new.codes == code]), photos, replace=False)
        for code in np.unique(new.codes)
    ]
    shown = np.isin(new.groups, np.concatenate(drawn))
    some, rest = new.only(shown), new.only(~shown)
    codes, test = new.codes[shown], new.codes[~shown]
    grey = some.bank[:, GREY]
    ways: dict[str, tuple[Neighbours, int, BoolArray]] = {
        ALONE: learned(Samples(grey, codes, some.groups), in_grey, judged=photos > 1),
        MIXED: learned(
            SamplesBesideOld(grey, codes, some.groups, old.bank[:, GREY], old.codes),
            in_grey,
            judged=photos > 1,
        ),
    }
    ways[OLD] = *as_it_is, answers(*as_it_is, grey) == codes
    found = {
        name: balanced_accuracy(test, answers(model, k, rest.bank[:, GREY]))
        for name, (model, k, _) in ways.items()
    }
    kept = ALONE
    if photos > 1:
        right = {name: of for name, (_, _, of) in ways.items()}
        kept = clearly_best(codes, right, some.groups)
    colour = some.bank[:, COLOUR]
    model, k, _ = learned(Samples(colour, codes, some.groups), in_colour, judged=photos > 1)
    return found, kept, balanced_accuracy(test, answers(model, k, rest.bank[:, COLOUR]))


def main() -> None:
    """Print the table."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--draws", type=int, default=10)
    parser.add_argument("--out", type=Path, default=None, help="keep the features here")
    arguments = parser.parse_args()
    images = Path(os.environ["TERRAIN_ODOMETRY_DATA"]) / "terrain-images"
    with tempfile.TemporaryDirectory() as scratch:
        store = arguments.out or Path(scratch)
        old = read(images / "ground", PER_OLD_PHOTO, store)
        new = read(images / "pavements", PER_PHOTO, store)
        copies = [read_copies(images / "pavements", columns, store) for columns in (GREY, COLOUR)]
    shared = np.intersect1d(old.labels, new.labels)
    old, new, *copies = (of.only(np.isin(of.labels, shared)) for of in (old, new, *copies))
    all_new = new, *(Samples(of.bank, of.codes, of.groups) for of in copies)
    as_it_is = learned(Samples(old.bank[:, GREY], old.codes, old.groups), judged=True)[:2]
    print(f"{', '.join(shared)}; mean [smallest, largest] of {arguments.draws} draws")
    for photos in (1, 3, 10):
        draws = [one_draw(old, as_it_is, all_new, photos, seed) for seed in range(arguments.draws)]
        columns = {name: [found[name] for found, _, _ in draws] for name in (OLD, MIXED, ALONE)}
        columns["kept"] = [found[kept] for found, kept, _ in draws]
        columns["alone, colour"] = [colour for _, _, colour in draws]
        text = "; ".join(
            f"{name} {np.mean(of):.3f} [{min(of):.2f}, {max(of):.2f}]"
            for name, of in columns.items()
        )
        print(f"{photos} photographs: {text}; {dict(Counter(kept for _, kept, _ in draws))}",
              flush=True)  # fmt: skip


if __name__ == "__main__":
    main()
