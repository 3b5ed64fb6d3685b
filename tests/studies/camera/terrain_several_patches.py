"""Whether the mean of the probabilities of an image's patches is calibrated, and could be.

    TERRAIN_ODOMETRY_DATA=... python -m tests.studies.camera.terrain_several_patches [PART...]
        [--out DIR]

The mean of several patches has a temperature T by their number n, 1/T = 1 + s log2(min(n, 16)): s,
the sharpening, is fitted to parts of photographs that were held out inside the training photographs
of each fold. Part `own`: five folds by photo_id, every choice inside the folds; calibration error
by patch, of parts of photographs of 4 and 12 patches (or a few more) that follow one another, and
of whole photographs; as the mean and sharpened, beside that of exact probabilities by chance
(photographs right or wrong as a whole). Its features are kept in --out. Part `unlike`: models of
four fifths of a folder (96 px, 12 patches a photograph, three folds) before images of up to 12
squares: those held out, as they are and altered (`terrain_confidence.py`), and the other folder's;
shares with a probability of 0.9 or more by the votes, and with a wrong one, calibration error.
"""

import argparse
import os
import tempfile
from dataclasses import dataclass
from pathlib import Path

import numpy as np
from scipy.optimize import minimize_scalar

from odometry.arrays import AnyArray, FloatArray, IntArray
from terrain.classification.classifier import TerrainClassifier
from terrain.classification.neighbours.calibration import (
    reliability,
    reliability_by_chance,
    tempered,
)
from terrain.classification.neighbours.neighbours import vote
from terrain.classification.neighbours.validation import Samples, best_way, grouped_folds
from terrain.classification.photographs.patches import LabelledPhoto, find_photos, load_patches
from terrain.classification.presets import PRESETS
from terrain.images import read_image
from tests.studies.camera.terrain_confidence import ALTERED, FOLDS, OTHER, SIZE_PX, SURE, Change
from tests.studies.camera.terrain_grounds import COLUMNS, Grounds, read_grounds
from tests.studies.camera.terrain_left_out import PARTS, middle

COUNTS, MOST = (2, 4, 8, 16), 2.25  # of patches; sharpening that makes T of 16 patches 0.1
WHOLE = 10_000  # patches: all of a photograph
OWN_SIZES_PX = {"ground": 128, "pavements": SIZE_PX}
SETS = {"ground": ("bank",), "pavements": ("bank", "bank and colour")}
Votes = tuple[IntArray, FloatArray, AnyArray]  # true codes (n,), probabilities, groups (n,)


def sharpened(of_patches: FloatArray, sharpening: float) -> FloatArray:
    """Probabilities (classes,) of an image by those of its patches (m, classes); by 0 the mean."""
    mean = of_patches.mean(axis=0)
    raised = (mean / mean.max()) ** (1 + sharpening * np.log2(min(len(of_patches), COUNTS[-1])))
    return np.asarray(raised / raised.sum())


def parts(groups: AnyArray, count: int) -> list[IntArray]:
    """Rows of patches that follow one another: parts of photographs, of so many or a few more."""
    members = [np.flatnonzero(groups == group) for group in np.unique(groups)]
    return [of for rows in members for of in np.array_split(rows, max(len(rows) // count, 1))]


def of_images(votes: Votes, images: list[IntArray], sharpening: float) -> Votes:
    """Those of images, by those of their patches."""
    codes, of_patches, groups = votes
    first = [rows[0] for rows in images]
    given = np.array([sharpened(of_patches[rows], sharpening) for rows in images])
    return codes[first], given, groups[first]


def fitted_sharpening(votes: Votes) -> float:
    """That at which true classes are likeliest, images of 2, 4, 8 and 16 patches alike.

    As if one photograph more had been of any class: a few that are all right are not certain.
    """
    images = [parts(votes[2], count) for count in COUNTS]
    unsure = 1 / (len(np.unique(votes[2])) + 1)

    def surprise(sharpening: float) -> float:
        total = 0.0
        for of in images:
            codes, given, _ = of_images(votes, of, sharpening)
            logs = np.log(np.maximum(given, np.finfo(float).tiny))
            true = logs[np.arange(len(codes)), codes]
            total -= float(np.mean((1 - unsure) * true + unsure * logs.mean(axis=1)))
        return total

    return float(minimize_scalar(surprise, bounds=(0.0, MOST), method="bounded").x)


def calibration(votes: Votes) -> str:
    """Calibration error, by how much too sure, and the error of exact probabilities by chance."""
    codes, given, groups = votes
    found, chance = reliability(codes, given), reliability_by_chance(given, groups)
    return f"{found.expected_error:.3f} ({found.mean_excess:+.3f}, {chance.expected_error:.3f})"


def joined(votes: list[Votes]) -> Votes:
    """Those of all folds."""
    codes, given, groups = zip(*votes, strict=True)
    return np.concatenate(codes), np.concatenate(given), np.concatenate(groups)


def own_study(name: str, grounds: Grounds, columns: slice) -> None:
    """Print the calibration of one folder out of fold."""
    preset, features = PRESETS["default"], grounds.bank[:, columns]
    found: dict[tuple[int, str], list[Votes]] = {}
    learned = []
    for train, test in grouped_folds(grounds.codes, grounds.groups):
        samples = Samples(features[train], grounds.codes[train], grounds.groups[train])
        way, inner = best_way(preset.ways, preset.neighbour_counts, samples, calibrates=True)
        sharpening = fitted_sharpening(
            (inner.codes, inner.probabilities, samples.groups[inner.rows])
        )
        learned.append(round(sharpening, 3))
        model = way().fit(*samples.with_copies(np.arange(len(train)), None))
        labels = model.labels(features[test], inner.n_neighbors)
        given = tempered(vote(labels, model.class_weights_), inner.temperature)
        votes = grounds.codes[test], given, grounds.groups[test]
        for count in (1, 4, 12, WHOLE):
            images = parts(grounds.photos[test], count)
            for kind, by in (("mean", 0.0), ("sharpened", sharpening)):
                found.setdefault((count, kind), []).append(of_images(votes, images, by))
    print(f"{name}: sharpening {learned}; calibration error (too sure by, error by chance)")
    for (count, kind), of in found.items():
        print(f"  {'all' if count == WHOLE else count} patches, {kind:9s}", calibration(joined(of)))


@dataclass(frozen=True)
class Shown:
    """An image's true terrain, probabilities of its squares (m, classes), and what to make of them.

    Sharpening and names of classes are those of the model.
    """

    label: str
    of_patches: FloatArray
    sharpening: float
    classes: AnyArray


def shown_to(
    model: TerrainClassifier, sharpening: float, photos: list[LabelledPhoto], change: Change
) -> list[Shown]:
    """The middle of photographs, changed, where they are as large as a square."""
    found = []
    for photo in photos:
        read = read_image(photo.path)
        image = change(read if read.ndim == 3 else np.repeat(read[..., None], 3, axis=2))
        if min(image.shape[:2]) >= SIZE_PX:
            features = model.patch_features(middle(image, *PARTS["up to 12 squares"]))
            votes = model.predict_proba(features)
            found.append(Shown(photo.label, votes, sharpening, model.classes_))
    return found


def unlike_line(shown: list[Shown]) -> str:
    """Sure, sure and wrong, and calibration error: as the mean, then sharpened."""
    cells = []
    for share in (0.0, 1.0):
        given = [sharpened(of.of_patches, share * of.sharpening) for of in shown]
        names = [of.classes[each.argmax()] for of, each in zip(shown, given, strict=True)]
        wrong = np.array(names) != np.array([of.label for of in shown])
        confidence = np.array([each.max() for each in given])
        sure = confidence >= SURE
        table = np.column_stack([confidence, np.zeros(len(given))])
        error = reliability(wrong.astype(int), table).expected_error
        cells.append(f"{sure.mean():.3f} {(wrong & sure).mean():.3f} {error:.3f}")
    return f"{len(shown):5d} {' | '.join(cells)}"


def unlike_study(root: Path, name: str) -> None:
    """Print what the votes of models of one folder say of images unlike it."""
    photos, other = find_photos(root / name), find_photos(root / OTHER[name])
    patches = load_patches(photos, SIZE_PX, max_per_photo=12)
    labels, groups = np.array(patches.labels), np.array(patches.groups)
    found: dict[str, list[Shown]] = {}
    for train, test in grouped_folds(np.unique(labels, return_inverse=True)[1], groups)[:FOLDS]:
        images = [patches.images[i] for i in train]
        model = TerrainClassifier().fit(images, labels[train], groups[train])
        inner = model.cross_validation_
        by = fitted_sharpening((inner.codes, inner.probabilities, groups[train][inner.rows]))
        held = [photo for photo in photos if photo.group in set(groups[test].tolist())]
        for kind, change in ALTERED.items():
            found.setdefault(kind, []).extend(shown_to(model, by, held, change))
        seen = shown_to(model, by, other, ALTERED["held out"])
        found.setdefault("the other folder", []).extend(seen)
    print(f"{name}: images; sure, sure and wrong, calibration error: the mean | sharpened")
    for kind, of in found.items():
        print(f"  {kind:24s}", unlike_line(of), flush=True)


def main() -> None:
    """Print the parts."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("parts", nargs="*", choices=[[], "own", "unlike"], default=[])
    parser.add_argument("--out", type=Path, default=None, help="keep the features here")
    arguments = parser.parse_args()
    chosen = arguments.parts or ("own", "unlike")
    root = Path(os.environ["TERRAIN_ODOMETRY_DATA"]) / "terrain-images"
    with tempfile.TemporaryDirectory() as scratch:
        for name, sets in SETS.items():
            if "own" in chosen:
                store, size_px = arguments.out or Path(scratch), OWN_SIZES_PX[name]
                grounds = read_grounds(root / name, size_px, store)
                for columns in sets:
                    own_study(f"{name}, {columns}", grounds, COLUMNS[columns])
            if "unlike" in chosen:
                unlike_study(root, name)


if __name__ == "__main__":
    main()
