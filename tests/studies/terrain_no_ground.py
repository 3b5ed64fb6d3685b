"""Images that show no ground: how many are unknown, before and with the check, and its price.

    TERRAIN_ODOMETRY_DATA=... python -m tests.studies.terrain_no_ground

Five folds by photo_id of ground/ (128 px) and pavements/ (96 px), 12 patches a photograph in
training. Each fold's model classifies the held-out photographs (whole, and their patches), patches
of real skies (the upper parts of camera-frames/husky, and of pictures of scikit-image), made skies,
black, white, walls, noise, and patches of held-out photographs that were blurred, over- and
underexposed. "Before" is the distance to the nearest class alone.
"""

import argparse
import os
from pathlib import Path

import cv2
import numpy as np
from skimage import data as pictures

from odometry.arrays import AnyArray, ByteImage
from odometry.run import UNKNOWN
from terrain.classification.classifier import TerrainClassifier
from terrain.classification.patches import LabelledPatches, cut_patches, find_photos, load_patches
from terrain.classification.trained import Classification
from terrain.classification.validation import grouped_folds
from terrain.images import read_image

MADE = 60
Shown = dict[str, list[ByteImage]]
Shares = dict[str, list[tuple[bool, bool]]]


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
    """Patches that show no ground."""
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


def refused(model: TerrainClassifier, answer: Classification) -> tuple[bool, bool]:
    """Before, and with the check."""
    return answer.distance > model.rejection_distance_, answer.label == UNKNOWN


def judged(
    model: TerrainClassifier, patches: LabelledPatches, test: AnyArray, empty: Shown, found: Shares
) -> None:
    """Add the answers of one fold's model to those of the others."""
    held_out = [patches.images[i] for i in test]
    shown = {"known, by patch": held_out} | empty | altered(held_out[::10])
    for name, images in shown.items():
        found.setdefault(name, []).extend(refused(model, of) for of in model.classify(images))
    files = dict.fromkeys(patches.photos[i] for i in test)
    answers = model.classify([read_image(file) for file in files])
    found.setdefault("known, by photograph", []).extend(refused(model, of) for of in answers)


def main() -> None:
    """Print the shares."""
    argparse.ArgumentParser(description=__doc__).parse_args()
    root = Path(os.environ["TERRAIN_ODOMETRY_DATA"])
    for folder, size in (("ground", 128), ("pavements", 96)):
        photos = find_photos(root / "terrain-images" / folder)
        patches = load_patches(photos, size, max_per_photo=12)
        labels, groups = np.array(patches.labels), np.array(patches.groups)
        empty, found = without_ground(root, size), Shares()
        for train, test in grouped_folds(np.unique(labels, return_inverse=True)[1], groups):
            images = [patches.images[i] for i in train]
            model = TerrainClassifier().fit(images, labels[train], groups[train])
            judged(model, patches, test, empty, found)
        print(f"{folder}: answers, unknown before, with the check")
        for name, answers in found.items():
            before, after = np.mean(answers, axis=0)
            print(f"  {name:24s} {len(answers):5d}  {before:.3f}  {after:.3f}", flush=True)


if __name__ == "__main__":
    main()
