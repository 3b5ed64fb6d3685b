"""What copies in another light bring to a model: in its own light, and in others.

    TERRAIN_ODOMETRY_DATA=... python -m tests.studies.camera.terrain_light colour|grey [FOLDER...]
        [--out FOLDER]

Five folds by photograph of ground/ and pavements/ (patches of 96 px); k, temperature and rejection
distances are chosen inside the training photographs, and copies follow their photograph. Patches
held out are shown as they are and in other lights that no copy was drawn from: in colour factors
of red, green and blue, in grey another exposure, haze, hard light or a gamma. Printed: balanced
accuracy by patch and by photograph, calibration error, the share that is sure (0.8 or more, within
the rejection distance), how many of these are wrong, and what the distance refuses. Features are
kept in --out.
"""

import argparse
import os
import tempfile
from dataclasses import replace
from pathlib import Path

import numpy as np

from odometry.arrays import AnyArray, ByteImage
from terrain.classification.features.feature_jobs import shared_feature_matrix
from terrain.classification.held_out import balanced_accuracy, photo_votes
from terrain.classification.neighbours.calibration import reliability
from terrain.classification.neighbours.validation import grouped_folds
from terrain.classification.photographs.patches import find_photos, load_patches
from terrain.classification.presets import PRESETS
from terrain.images import to_grey
from tests.studies.camera.terrain_grounds import GREY, PER_COPY, Grounds, choose, lit_copies

SIZE_PX, SURE = 96, 0.8
AS_IT_IS = "as it is"


def in_light(image: ByteImage, gains: tuple[float, float, float]) -> ByteImage:
    """An image with factors of red, green and blue."""
    return _as_bytes(image * np.array(gains))


def with_contrast(image: ByteImage, contrast: float) -> ByteImage:
    """An image with another contrast about its mean."""
    return _as_bytes(image.mean() + contrast * (image - image.mean()))


def _as_bytes(values: AnyArray) -> ByteImage:
    return np.clip(np.rint(values), 0, 255).astype(np.uint8)


LIGHTS = {
    "colour": {
        AS_IT_IS: lambda image: image,
        "warm": lambda image: in_light(image, (1.2, 1.0, 0.8)),
        "low sun": lambda image: in_light(image, (1.25, 1.0, 0.7)),
        "cool": lambda image: in_light(image, (0.85, 1.0, 1.2)),
        "greenish": lambda image: in_light(image, (0.9, 1.1, 0.9)),
    },
    "grey": {
        AS_IT_IS: lambda image: image,
        "dark": lambda image: _as_bytes(0.55 * image),
        "bright": lambda image: _as_bytes(1.5 * image.astype(float)),
        "haze": lambda image: with_contrast(image, 0.6),
        "hard": lambda image: with_contrast(image, 1.5),
        "gamma 1.6": lambda image: _as_bytes(255 * (image / 255) ** 1.6),
        "gamma 0.6": lambda image: _as_bytes(255 * (image / 255) ** 0.6),
    },
}
STRUCTURES = {"colour": ("bank and colour",), "grey": ("bank",)}


def in_a_light(folder: Path, kind: str, name: str, store: Path) -> Grounds:
    """Features of the patches of a folder, in a light or as copies for training."""
    file = store / f"{folder.name}_{kind}_{name.replace(' ', '_')}.npz"
    if not file.exists():
        shown = load_patches(find_photos(folder), SIZE_PX)
        photos = [str(photo) for photo in shown.photos]
        if kind == "grey":
            shown = replace(shown, images=[to_grey(image) for image in shown.images])
        if name == "copies":
            shown = lit_copies(shown, colour=kind == "colour")
            photos, images = shown.groups, shown.images
        else:
            images = [LIGHTS[kind][name](image) for image in shown.images]
        preset = PRESETS["default"]
        settings = preset.colour_features if kind == "colour" else preset.features
        made = shared_feature_matrix(images, settings, processes=1)
        np.savez(file, made, shown.labels, shown.groups, photos)
    with np.load(file) as arrays:
        made, *named = (arrays[f"arr_{i}"] for i in range(4))
    unasked = np.zeros((len(made), GREY.stop))
    bank = np.hstack([unasked, made]) if kind == "colour" else made
    return Grounds(bank[:, :PER_COPY], bank, *named)


def measured(kind: str, shown: dict[str, Grounds], copies: Grounds | None) -> None:
    """Print a line for each light."""
    own = shown[AS_IT_IS]
    shape = len(own.labels), len(np.unique(own.labels))
    answers = {name: np.zeros(shape) for name in shown}
    beyond = {name: np.zeros(len(own.labels)) for name in shown}
    for train, test in grouped_folds(own.codes, own.groups):
        model = choose(
            PRESETS["default"], STRUCTURES[kind], own.bank[train], own.only(train), copies
        )
        for name, patches in shown.items():
            answers[name][test] = model.probabilities(patches.bank[test])
            distances = model.distances(patches.bank[test])
            beyond[name][test] = distances / model.rejection_distances[0]
    for name, probabilities in answers.items():
        codes, given = own.codes, probabilities.argmax(axis=1)
        by_photo = balanced_accuracy(*photo_votes(codes, probabilities, own.photos)[:2])
        sure = (probabilities.max(axis=1) >= SURE) & (beyond[name] <= 1)
        cells = (
            balanced_accuracy(codes, given),
            by_photo,
            reliability(codes, probabilities).expected_error,
            sure.mean(),
            (given != codes)[sure].mean(),
            (beyond[name] > 1).mean(),
        )
        print(f"  {name:12s}", *(f"{cell:6.3f}" for cell in cells), flush=True)


def main() -> None:
    """Measure without copies, and with them."""
    images = Path(os.environ["TERRAIN_ODOMETRY_DATA"]) / "terrain-images"
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("kind", choices=LIGHTS)
    parser.add_argument("folders", nargs="*", default=["ground", "pavements"])
    parser.add_argument("--out", type=Path, default=None, help="keep the features here")
    arguments = parser.parse_args()
    with tempfile.TemporaryDirectory() as scratch:
        store = arguments.out or Path(scratch)
        store.mkdir(parents=True, exist_ok=True)
        for folder in arguments.folders:
            of = images / folder, arguments.kind
            shown = {name: in_a_light(*of, name, store) for name in LIGHTS[arguments.kind]}
            copies = in_a_light(*of, "copies", store)
            for with_copies in (None, copies):
                print(f"{folder}, {'with' if with_copies else 'without'} copies")
                print("  light         patch  photo  error   sure  wrong refused")
                measured(arguments.kind, shown, with_copies)


if __name__ == "__main__":
    main()
