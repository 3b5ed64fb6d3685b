"""What altered copies bring: the own camera, other cameras, unknown terrain, calibration.

    TERRAIN_ODOMETRY_DATA=... python -m tests.studies.camera.terrain_cameras [PART...]
        [--out FOLDER]

Folds keep photographs (photo_id) whole, and altered copies follow their photograph. k, temperature
and rejection distances are chosen inside the training photographs alone; `unknown` is evaluated on
two of the five folds. Other cameras are the folder pavements/, and photographs of ground/ that were
blurred, darkened, made noisy or reduced to a quarter. Features are kept in --out.
"""

import argparse
import os
import tempfile
from collections.abc import Callable
from dataclasses import replace
from functools import partial
from pathlib import Path

import cv2
import numpy as np

from odometry.arrays import AnyArray, ByteImage
from terrain.classification.features.feature_jobs import shared_feature_matrix
from terrain.classification.held_out import (
    balanced_accuracy,
    balanced_accuracy_interval,
    photo_votes,
    rejection_roc_area,
)
from terrain.classification.neighbours.calibration import reliability
from terrain.classification.neighbours.validation import grouped_folds
from terrain.classification.own_statistics import Moments, own_scaler, own_weight
from terrain.classification.photographs.patches import cut_patches, find_photos
from terrain.classification.photographs.trained_on import image_sum
from terrain.classification.presets import PRESETS
from terrain.images import read_image
from tests.studies.camera.terrain_grounds import Chosen, Grounds, choose, read_copies, read_grounds

SHOWN_PATCHES = 4  # of each photograph by a simulated camera
UNKNOWN_FOLDS = 2
GREY, COLOUR = ("bank",), ("bank and colour",)
learnt = partial(choose, PRESETS["default"])


def lens_cap(image: ByteImage) -> ByteImage:
    """Black, and the noise of the sensor."""
    noise = np.random.default_rng(int(image_sum(image), 16)).normal(4, 3, image.shape)
    return np.clip(noise, 0, 255).astype(np.uint8)


def sky(image: ByteImage) -> ByteImage:
    """Bright and smooth."""
    rng = np.random.default_rng(int(image_sum(image), 16))
    rows = np.linspace(0, 30, image.shape[0])[:, None, None]
    grey = np.array([170, 190, 220]) + rows + rng.normal(0, 2, image.shape)
    return np.clip(grey, 0, 255).astype(np.uint8)


def noisy(image: ByteImage) -> ByteImage:
    """Noise of 15 grey levels."""
    noise = np.random.default_rng(int(image_sum(image), 16)).normal(0, 15, image.shape)
    return np.clip(image + noise, 0, 255).astype(np.uint8)


CAMERAS: dict[str, Callable[[ByteImage], ByteImage]] = {
    "blur of 3 px": lambda image: cv2.GaussianBlur(image, (0, 0), 3.0),
    "gamma 2.2": lambda image: (255 * (image / 255) ** 2.2).astype(np.uint8),
    "noise of 15": noisy,
    "white balance 1.3, 1, 0.7": lambda image: np.clip(image * [1.3, 1.0, 0.7], 0, 255).astype(
        np.uint8
    ),
    "a quarter as large": lambda image: cv2.resize(
        image, None, fx=0.25, fy=0.25, interpolation=cv2.INTER_AREA
    ),
    "lens cap": lens_cap,
    "sky": sky,
}


def by_camera(folder: Path, size_px: int, name: str, store: Path) -> Grounds:
    """Some patches of each photograph as a simulated camera shows it."""
    file = store / f"{folder.name}_{size_px}_{name.replace(' ', '_')}.npz"
    if not file.exists():
        patches, rows = [], []
        for photo in find_photos(folder):
            image = CAMERAS[name](read_image(photo.path))
            cut = cut_patches(image, size_px)
            chosen = np.unique(np.linspace(0, len(cut) - 1, SHOWN_PATCHES).astype(int))
            patches += [cut[i] for i in chosen if cut]
            rows += [(photo.label, photo.group, str(photo.path)) for _ in chosen if cut]
        bank = shared_feature_matrix(patches, PRESETS["default"].features, processes=1)
        np.savez(file, bank, *zip(*rows, strict=True))
    with np.load(file) as arrays:
        bank, *named = (arrays[f"arr_{i}"] for i in range(4))
        return Grounds(bank, bank, *named)


def own_camera(name: str, grounds: Grounds, copies: Grounds | None, ways: tuple[str, ...]) -> None:
    """Accuracy and calibration out of fold."""
    classes = len(np.unique(grounds.labels))
    probabilities = np.zeros((len(grounds.labels), classes))
    for train, test in grouped_folds(grounds.codes, grounds.groups):
        model = learnt(ways, grounds.bank[train], grounds.only(train), copies)
        probabilities[test] = model.probabilities(grounds.bank[test])
    codes, answers = grounds.codes, probabilities.argmax(axis=1)
    by_photo = np.array([probabilities[grounds.photos == p].mean(0) for p in photos_of(grounds)])
    photo_codes, photo_answers, rows = photo_votes(codes, probabilities, grounds.photos)
    print(f"{name}, {'with' if copies else 'without'} copies")
    print("  by patch", scored(codes, answers, grounds.groups))
    print("  by photo", scored(photo_codes, photo_answers, grounds.groups[rows]))
    errors = [
        reliability(c, p).expected_error
        for c, p in ((codes, probabilities), (photo_codes, by_photo))
    ]
    print(
        "  expected calibration error by patch {:.3f}, by photo {:.3f}".format(*errors), flush=True
    )


def photos_of(grounds: Grounds) -> AnyArray:
    """In the order of `photo_votes`."""
    return np.unique(grounds.photos)


def scored(codes: AnyArray, answers: AnyArray, groups: AnyArray) -> str:
    """Balanced accuracy with its interval over photographs."""
    low, high = balanced_accuracy_interval(codes, answers, groups, np.random.default_rng(0))
    return f"{balanced_accuracy(codes, answers):.3f} [{low:.3f}, {high:.3f}]"


def judged(name: str, model: Chosen, classes: AnyArray, shown: Grounds) -> None:
    """Right, refused, and right or refused: by patch and by the median of a photograph."""
    features = shown.bank
    probabilities, distances = model.probabilities(features), model.distances(features)
    codes = np.searchsorted(classes, shown.labels)
    right = probabilities.argmax(axis=1) == codes
    refused = distances > model.rejection_distances[0]
    photo_codes, photo_answers, _ = photo_votes(codes, probabilities, shown.photos)
    photo_refused = model.photo_distances(features, shown.photos) > model.rejection_distances[0]
    cells = [
        balanced_accuracy(codes, probabilities.argmax(axis=1)),
        refused.mean(),
        (right | refused).mean(),
        balanced_accuracy(photo_codes, photo_answers),
        photo_refused.mean(),
        ((photo_codes == photo_answers) | photo_refused).mean(),
    ]
    print(f"  {name:28s}", *(f"{cell:6.3f}" for cell in cells), flush=True)


def other_cameras(folder: Path, grounds: Grounds, copies: Grounds | None, store: Path) -> None:
    """Train on four folds, evaluate on the fifth as other cameras show it."""
    train, test = grouped_folds(grounds.codes, grounds.groups)[0]
    model = learnt(GREY, grounds.bank[train], grounds.only(train), copies)
    classes, held = np.unique(grounds.labels), grounds.only(test)
    print(f"{'with' if copies else 'without'} copies: right, refused, either; the same by photo")
    judged("the own camera", model, classes, held)
    for name in CAMERAS:
        shown = by_camera(folder, 128, name, store)
        judged(name, model, classes, shown.only(np.isin(shown.groups, held.groups)))


def new_camera(old: Grounds, copies: Grounds | None, new: Grounds) -> None:
    """Train on all of one folder's shared classes, evaluate on another's."""
    common = np.intersect1d(old.labels, new.labels)
    old, new = (g.only(np.isin(g.labels, common)) for g in (old, new))
    model = learnt(GREY, old.bank, old, copies)
    print(f"ground to pavements, {'with' if copies else 'without'} copies: {', '.join(common)}")
    judged("as they are", model, common, new)
    judged("standardised by their own", standardised(model, new), common, new)


def standardised(model: Chosen, shown: Grounds) -> Chosen:
    """The classifier with the statistics of the patches, as far as `own_weight` goes."""
    neighbours, features = model.model, shown.bank[:, model.columns]
    moments = Moments.of(features, neighbours.discriminants(features))
    weight = own_weight(neighbours, moments)
    print(f"  weight of their own statistics {weight:.2f}")
    scaler = own_scaler(neighbours.scaler, moments, weight)
    return replace(model, model=neighbours.rescaled(scaler))


def unknown_terrain(grounds: Grounds, copies: Grounds | None) -> None:
    """Leave one class out: is it farther away than held-out photographs of the others?"""
    print(f"unknown, {'with' if copies else 'without'} copies: area by patch, by photo; ", end="")
    print("refused of unknown, of known patches; of unknown, of known photographs")
    table = []
    for label in np.unique(grounds.labels):
        known, unknown = (
            grounds.only(m) for m in (grounds.labels != label, grounds.labels == label)
        )
        for train, test in grouped_folds(known.codes, known.groups)[:UNKNOWN_FOLDS]:
            part, held = known.only(train), known.only(test)
            table.append(refusals(learnt(GREY, part.bank, part, copies), held, unknown))
        means = np.mean(table[-UNKNOWN_FOLDS:], axis=0)
        print(f"  without {label:14s}", *(f"{value:6.3f}" for value in means), flush=True)
    print("  mean                  ", *(f"{value:6.3f}" for value in np.mean(table, axis=0)))


def refusals(model: Chosen, held: Grounds, unknown: Grounds) -> list[float]:
    """Areas and refused shares, by patch and by photograph."""
    near, far = (model.distances(g.bank) for g in (held, unknown))
    near_photo, far_photo = (model.photo_distances(g.bank, g.photos) for g in (held, unknown))
    limit = model.rejection_distances[0]
    areas = [rejection_roc_area(near, far), rejection_roc_area(near_photo, far_photo)]
    return areas + [float(np.mean(of > limit)) for of in (far, near, far_photo, near_photo)]


def main() -> None:
    """Run the parts of the study and print their figures."""
    parser = argparse.ArgumentParser(description=__doc__)
    parts = ("own", "new", "cameras", "unknown")
    parser.add_argument("parts", nargs="*", choices=[[], *parts], default=[])
    parser.add_argument("--out", type=Path, default=None, help="keep the features here")
    arguments = parser.parse_args()
    images = Path(os.environ["TERRAIN_ODOMETRY_DATA"]) / "terrain-images"
    with tempfile.TemporaryDirectory() as scratch:
        store = arguments.out or Path(scratch)
        for part in arguments.parts or parts:
            run_part(part, images, store)


def run_part(part: str, images: Path, store: Path) -> None:
    """One part of the study, without and with altered copies."""
    size_px = 96 if part == "new" else 128
    grounds = read_grounds(images / "ground", size_px, store)
    found = read_copies(images / "ground", size_px, store)
    if part in {"new", "own"}:
        pavements = read_grounds(images / "pavements", 96, store)
    for copies in (None, found):
        if part == "own":
            own_camera("ground, grey", grounds, copies, GREY)
            of = copies and read_copies(images / "pavements", 96, store)
            own_camera("pavements, grey", pavements, of, GREY)
            own_camera("pavements, colour", pavements, of, COLOUR)
        elif part == "new":
            new_camera(grounds, copies, pavements)
        elif part == "cameras":
            other_cameras(images / "ground", grounds, copies, store)
        else:
            unknown_terrain(grounds, copies)


if __name__ == "__main__":
    main()
