"""What copies in another white balance bring to a model in colour: own light, other lights.

    TERRAIN_ODOMETRY_DATA=... python -m tests.studies.terrain_light [FOLDER...] [--out FOLDER]

Five folds by photograph of ground/ and pavements/ (patches of 96 px); k, temperature and rejection
distances are chosen inside the training photographs, and copies follow their photograph. Patches
held out are shown as they are and in other lights: factors of red, green and blue that no copy was
drawn from. Printed: balanced accuracy by patch and by photograph, calibration error, the share that
is sure (0.8 or more, within the rejection distance), how many of these are wrong, and what the
distance refuses. Features are kept in --out.
"""

import argparse
import os
import tempfile
from pathlib import Path

import numpy as np

from odometry.arrays import ByteImage
from terrain.classification.features.feature_jobs import shared_feature_matrix
from terrain.classification.held_out import balanced_accuracy, photo_votes
from terrain.classification.neighbours.calibration import reliability
from terrain.classification.neighbours.validation import grouped_folds
from terrain.classification.photographs.patches import find_photos, load_patches
from terrain.classification.presets import PRESETS
from tests.studies.terrain_grounds import GREY, PER_COPY, Grounds, balanced_copies, choose

SIZE_PX, SURE = 96, 0.8
COLOUR = ("bank and colour",)
LIGHTS = {
    "as it is": (1.0, 1.0, 1.0),
    "warm": (1.2, 1.0, 0.8),
    "low sun": (1.25, 1.0, 0.7),
    "cool": (0.85, 1.0, 1.2),
    "greenish": (0.9, 1.1, 0.9),
}


def in_light(image: ByteImage, gains: tuple[float, float, float]) -> ByteImage:
    """An image with factors of red, green and blue."""
    return np.clip(np.rint(image * np.array(gains)), 0, 255).astype(np.uint8)


def in_colour(folder: Path, name: str, store: Path) -> Grounds:
    """Features in colour of the patches of a folder, in a light or as copies for training."""
    file = store / f"{folder.name}_{name.replace(' ', '_')}.npz"
    if not file.exists():
        shown = load_patches(find_photos(folder), SIZE_PX)
        photos = [str(photo) for photo in shown.photos]
        if name == "copies":
            shown = balanced_copies(shown)
            photos = shown.groups
            images = shown.images
        else:
            images = [in_light(image, LIGHTS[name]) for image in shown.images]
        made = shared_feature_matrix(images, PRESETS["default"].colour_features, processes=1)
        np.savez(file, made, shown.labels, shown.groups, photos)
    with np.load(file) as arrays:
        made, *named = (arrays[f"arr_{i}"] for i in range(4))
    bank = np.hstack([np.zeros((len(made), GREY.stop)), made])  # nothing in grey is asked for
    return Grounds(bank[:, :PER_COPY], bank, *named)


def measured(shown: dict[str, Grounds], copies: Grounds | None) -> None:
    """Print a line for each light."""
    own = shown["as it is"]
    shape = len(own.labels), len(np.unique(own.labels))
    answers = {name: np.zeros(shape) for name in shown}
    beyond = {name: np.zeros(len(own.labels)) for name in shown}
    for train, test in grouped_folds(own.codes, own.groups):
        model = choose(PRESETS["default"], COLOUR, own.bank[train], own.only(train), copies)
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
    parser.add_argument("folders", nargs="*", default=["ground", "pavements"])
    parser.add_argument("--out", type=Path, default=None, help="keep the features here")
    arguments = parser.parse_args()
    with tempfile.TemporaryDirectory() as scratch:
        store = arguments.out or Path(scratch)
        store.mkdir(parents=True, exist_ok=True)
        for folder in arguments.folders:
            shown = {name: in_colour(images / folder, name, store) for name in LIGHTS}
            copies = in_colour(images / folder, "copies", store)
            for with_copies in (None, copies):
                print(f"{folder}, {'with' if with_copies else 'without'} copies")
                print("  light         patch  photo  error   sure  wrong refused")
                measured(shown, with_copies)


if __name__ == "__main__":
    main()
