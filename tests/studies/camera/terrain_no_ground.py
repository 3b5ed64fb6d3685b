"""Images that show no terrain: how many are unknown, before and with the check, and its price.

    TERRAIN_ODOMETRY_DATA=... python -m tests.studies.camera.terrain_no_ground

Five folds by photo_id of ground/ (128 px) and pavements/ (96 px), 12 patches a photograph in
training. Each fold's model classifies the held-out photographs (whole, and their patches), patches
of real skies (the upper parts of camera-frames/husky, and of pictures of scikit-image), made skies,
black, white, walls, noise, patches of held-out photographs that were blurred, over- and
underexposed, and things (`terrain_things.py`). Things whose photographs a model is taught are
judged by one that did not see them, the others are a test. The last lines are of patches of
pavements/ by a model of ground/ (96 px).
"""

import argparse
import os
from collections.abc import Callable
from copy import copy
from functools import cache, partial
from pathlib import Path

import cv2
import numpy as np
from skimage import data as pictures

from odometry.arrays import AnyArray, ByteImage, FloatArray, IntArray
from odometry.recording.run import UNKNOWN
from terrain.classification.answer import Classification
from terrain.classification.classifier import TerrainClassifier
from terrain.classification.features.features import feature_matrix
from terrain.classification.neighbours.validation import grouped_folds
from terrain.classification.other_things import (
    PHOTOGRAPHS,
    SQUARES,
    THINGS,
    OtherThings,
    squares_of,
)
from terrain.classification.photographs.patches import (
    LabelledPatches,
    cut_patches,
    find_photos,
    load_patches,
)
from terrain.classification.presets import PRESETS
from terrain.images import read_image
from tests.studies.camera.terrain_things import development, reserved

MADE = 60
Shown = dict[str, list[ByteImage]]
Refusals = list[tuple[bool, bool, bool, bool]]
Shares = dict[str, Refusals]
NEARER_SHARE = 0.07
TAUGHT_BY = {
    "cat": "cat",
    "cup on a table": "coffee",
    "person": "astronaut",
    "coins": "coins",
    "page": "page",
    "handwriting": "text",
    "handwriting, twice as large": "text",
    "chessboard": "checkerboard",
}  # of which photograph in training a source is


def made_sky(rng: np.random.Generator, size: int) -> ByteImage:
    """From blue to pale, mostly with clouds and JPEG, and the noise of a sensor."""
    top = np.array([rng.integers(60, 150), rng.integers(110, 180), rng.integers(170, 240)])
    depth = np.linspace(0, rng.uniform(0.1, 1), size)[:, None, None]
    image = np.repeat(top * (1 - depth) + rng.integers(180, 240) * depth, size, axis=1)
    if rng.random() < 0.6:
        sigmas = (4, 8, 16, 32)
        clouds = sum(
            s * cv2.GaussianBlur(rng.normal(0, 1, (size, size)), (0, 0), s) for s in sigmas
        )
        clouds = (clouds - clouds.min()) / np.ptp(clouds)
        image = image + rng.uniform(10, 120) * clouds[..., None]
    sky = np.clip(image + rng.normal(0, rng.uniform(0.3, 4), image.shape), 0, 255).astype(np.uint8)
    return jpeg(sky, int(rng.integers(50, 96))) if rng.random() < 0.7 else sky


def jpeg(image: ByteImage, quality: int) -> ByteImage:
    """The image after compression."""
    coded = cv2.imencode(".jpg", image, [cv2.IMWRITE_JPEG_QUALITY, quality])[1]
    return np.asarray(cv2.imdecode(coded, cv2.IMREAD_COLOR), np.uint8)


def even(rng: np.random.Generator, size: int, low: float, high: float, noise: float) -> ByteImage:
    """One grey, and the noise of a sensor."""
    grey = rng.normal(rng.uniform(low, high), rng.uniform(0.3, noise), (size, size, 3))
    return np.clip(grey, 0, 255).astype(np.uint8)


def without_ground(root: Path, size: int) -> Shown:
    """Patches that show no terrain."""
    rng = np.random.default_rng(5)
    front, rear = (read_image(root / "camera-frames" / "husky" / f"camera_{of}.jpg")
                   for of in ("front", "rear"))  # fmt: skip
    camera = np.stack([pictures.camera()] * 3, axis=-1)
    return {
        "sky, husky front": cut_patches(front[:400], size),
        "sky, husky rear": cut_patches(rear[:230], size),
        "sky, cameraman": cut_patches(camera[:128, :256], size)
        + cut_patches(camera[:128, 384:], size),
        "sky, rocket": cut_patches(pictures.rocket()[:128], size),
        "sky, made": [made_sky(rng, size) for _ in range(MADE)],
        "black": [even(rng, size, 0, 8, 4) for _ in range(MADE)],
        "white": [even(rng, size, 250, 260, 4) for _ in range(MADE)],
        "grey wall": [even(rng, size, 90, 220, 3) for _ in range(MADE)],
        "noise": [even(rng, size, 80, 180, 70) for _ in range(MADE)],
    }


def altered(patches: list[ByteImage]) -> Shown:
    """Ground that can hardly be seen."""
    return {
        "blur of 5 px": [cv2.GaussianBlur(of, (0, 0), 5) for of in patches],
        "blur of 10 px (covered)": [cv2.GaussianBlur(of, (0, 0), 10) for of in patches],
        "four times as bright": [np.clip(of * 4.0, 0, 255).astype(np.uint8) for of in patches],
        "a tenth as bright": [(of * 0.1).astype(np.uint8) for of in patches],
    }


def refused(model: TerrainClassifier, answers: list[Classification]) -> Refusals:
    """By the distance alone, with the check for ground, with that for things; by a nearer distance.

    Beyond the nearer one lie 7 % of the training patches; with it goes the check for ground alone.
    """
    nearer = np.quantile(model.cross_validation_.image_distances[0], 1 - NEARER_SHARE)
    rows = []
    for answer in answers:
        far = answer.distance > model.rejection_distance_
        empty = answer.reason not in {"", THINGS}
        instead = answer.distance > nearer or empty
        rows.append((far, far or empty, answer.label == UNKNOWN, instead))
    return rows


def judged(
    model: TerrainClassifier, patches: LabelledPatches, rows: AnyArray, empty: Shown, found: Shares
) -> None:
    """Add the answers of one fold's model to those of the others."""
    held_out = [patches.images[i] for i in rows]
    shown = {"known, by patch": held_out} | empty | altered(held_out[::10])
    for name, images in shown.items():
        found.setdefault(name, []).extend(refused(model, model.classify(images)))
    files = dict.fromkeys(patches.photos[i] for i in rows)
    answers = model.classify([read_image(file) for file in files])
    found.setdefault("known, by photograph", []).extend(refused(model, answers))


def judged_on_things(
    model: TerrainClassifier, taught: Callable[[str], OtherThings], size: int, found: Shares
) -> None:
    """The same of things; for those that a model is taught by one that did not see them."""
    for name, images in development(size).items():
        other = copy(model)
        other.other_things_ = taught(TAUGHT_BY.get(name, ""))
        found.setdefault(f"{name} (left out)", []).extend(refused(other, other.classify(images)))
    for name, images in reserved(size).items():
        found.setdefault(f"{name} (test)", []).extend(refused(model, model.classify(images)))


def of_other_camera(root: Path, model: TerrainClassifier) -> None:
    """Patches of pavements/ by a model of ground/ at the same scale: right, or refused."""
    found = load_patches(find_photos(root / "pavements"), model.patch_size_px, max_per_photo=12)
    of = [i for i, label in enumerate(found.labels) if label in model.classes_]
    answers = model.classify([found.images[i] for i in of])
    names = model.classes_.tolist()
    right = [names[np.argmax(list(each.probabilities.values()))] == found.labels[i]
             for each, i in zip(answers, of, strict=True)]  # fmt: skip
    table = np.array(refused(model, answers))
    either = (table | np.array(right)[:, None]).mean(axis=0)
    print("ground/ to pavements/: refused", *(f"{share:.3f}" for share in table.mean(axis=0)))
    print("  right or refused            ", *(f"{share:.3f}" for share in either), flush=True)


def main() -> None:
    """Print the shares."""
    argparse.ArgumentParser(description=__doc__).parse_args()
    root = Path(os.environ["TERRAIN_ODOMETRY_DATA"])
    for folder, size in (("ground", 128), ("pavements", 96)):
        photos = find_photos(root / "terrain-images" / folder)
        patches = load_patches(photos, size, max_per_photo=12)
        labels, groups = np.array(patches.labels), np.array(patches.groups)
        codes = np.unique(labels, return_inverse=True)[1]
        features = feature_matrix(patches.images, PRESETS["default"].features)
        things = feature_matrix(squares_of(PHOTOGRAPHS, size), PRESETS["default"].features)
        empty, found = without_ground(root, size), Shares()
        for train, held_out in grouped_folds(codes, groups):
            images = [patches.images[i] for i in train]
            model = TerrainClassifier().fit(images, labels[train], groups[train])
            scaled = [model.neighbours.scaler.transform(of) for of in (features[train], things)]
            taught = partial(_taught, codes[train], groups[train], *scaled)
            judged(model, patches, held_out, empty, found)
            judged_on_things(model, cache(taught), size, found)
        print(
            f"{folder}: answers; unknown by distance, with ground, now; by {NEARER_SHARE} instead"
        )
        for name, answers in found.items():
            shares = np.mean(answers, axis=0)
            print(f"  {name:38s} {len(answers):5d} ", *(f"{of:.3f}" for of in shares), flush=True)
    photos = find_photos(root / "terrain-images" / "ground")
    patches = load_patches(photos, 96, max_per_photo=12)
    of_other_camera(
        root / "terrain-images",
        TerrainClassifier().fit(patches.images, patches.labels, patches.groups),
    )


def _taught(
    codes: IntArray, groups: AnyArray, terrain: FloatArray, things: FloatArray, left_out: str
) -> OtherThings:
    """What a model learns of scaled features without those of one photograph of things."""
    others = np.repeat(PHOTOGRAPHS, SQUARES) != left_out
    return OtherThings.of(terrain, codes, groups, things[others])


if __name__ == "__main__":
    main()
