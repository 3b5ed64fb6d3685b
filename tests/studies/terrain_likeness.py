"""Whether a model notices images that are unlike its training photographs, and its false alarms.

    TERRAIN_ODOMETRY_DATA=... python tests/studies/terrain_likeness.py

A run is twelve squares at random, up to four of a photograph, of one terrain or of all. The own
camera: photographs of ground/ that were held out (five folds by photo_id). Unlike: the same,
blurred (3 px), at gamma 2 and 0.5, at a quarter of the scale, noisy (10 grey levels); another
camera: pavements/, and the lower halves of camera-frames/. Shares of runs with the note, the mean
over folds.
"""

import argparse
import os
from collections.abc import Callable
from dataclasses import dataclass
from pathlib import Path

import cv2
import numpy as np

from odometry.arrays import AnyArray, ByteImage, FloatArray
from terrain.classification.likeness import TrainingLook, look_of
from terrain.classification.patches import cut_patches, find_photos, load_patches
from terrain.classification.validation import grouped_folds
from terrain.images import read_image, to_grey

SIZE_PX, SQUARES, RUN, RUNS = 96, 4, 12, 100


def gamma(power: float) -> Callable[[ByteImage], ByteImage]:
    """Another exposure: grey to a power."""
    table = np.rint(255 * (np.arange(256) / 255) ** power).astype(np.uint8)
    return lambda image: table[image]


def noisy(image: ByteImage) -> ByteImage:
    """Noise of 10 grey levels."""
    noise = np.random.default_rng(0).normal(0, 10, image.shape)
    return np.clip(image + noise, 0, 255).astype(np.uint8)


ALTERED: dict[str, Callable[[ByteImage], ByteImage]] = {
    "own camera": lambda image: image,
    "blur of 3 px": lambda image: cv2.GaussianBlur(image, (0, 0), 3),
    "gamma 0.5": gamma(0.5),
    "gamma 2": gamma(2.0),
    "a quarter of the scale": lambda image: cv2.resize(
        image, None, fx=0.25, fy=0.25, interpolation=cv2.INTER_AREA
    ),
    "noise of 10 levels": noisy,
}


@dataclass(frozen=True)
class Looks:
    """Looks (n, 6) of photographs and their terrains."""

    looks: FloatArray
    labels: AnyArray

    def share(self, training: TrainingLook, terrains: list[str], rng: np.random.Generator) -> float:
        """Share of runs over some of the terrains that get the note."""
        rows = np.flatnonzero(np.isin(self.labels, terrains))
        size = min(RUN, len(rows))
        runs = [rng.choice(rows, size, replace=False) for _ in range(RUNS)]
        return float(np.mean([bool(training.compared(self.looks[run]).is_unlike) for run in runs]))


def looks_of(folder: Path, change: Callable[[ByteImage], ByteImage]) -> tuple[Looks, AnyArray]:
    """Looks of squares of every photograph, changed, and their photo_ids."""
    photos = find_photos(folder)
    found = []
    for photo in photos:
        squares = cut_patches(change(to_grey(read_image(photo.path))), SIZE_PX)
        kept = np.linspace(0, len(squares) - 1, min(len(squares), SQUARES)).astype(int)
        found += [(look_of(squares[i]), photo.label, photo.group) for i in kept]
    looks, labels, groups = map(np.array, zip(*found, strict=True))
    return Looks(looks, labels), groups


def main() -> None:
    """Print the shares."""
    argparse.ArgumentParser(description=__doc__).parse_args()
    root = Path(os.environ["TERRAIN_ODOMETRY_DATA"])
    ground = root / "terrain-images" / "ground"
    patches = load_patches(find_photos(ground), SIZE_PX, max_per_photo=12)
    names, codes = np.unique(patches.labels, return_inverse=True)
    groups, rng = np.array(patches.groups), np.random.default_rng(1)
    folds = []
    for train, test in grouped_folds(codes, groups):
        learned = [patches.images[i] for i in train]
        folds.append((TrainingLook.of(learned, codes[train], groups[train]), set(groups[test])))
    print("share of runs with the note: over all terrains; over one terrain each")
    for name, change in ALTERED.items():
        every, of = looks_of(ground, change)
        for terrains in (list(names), *([one] for one in names)):
            shares = []
            for training, held_out in folds:
                rows = np.isin(of, list(held_out))
                some = Looks(every.looks[rows], every.labels[rows])
                shares.append(some.share(training, terrains, rng))
            print(f"{name}, {'all' if len(terrains) > 1 else terrains[0]}: {np.mean(shares):.2f}",
                  flush=True)  # fmt: skip
    whole = TrainingLook.of(patches.images, codes, groups)
    pavements, _ = looks_of(root / "terrain-images" / "pavements", lambda image: image)
    for terrains in (sorted(set(pavements.labels)), *([n] for n in sorted(set(pavements.labels)))):
        share = pavements.share(whole, terrains, rng)
        print(f"pavements, {'all' if len(terrains) > 1 else terrains[0]}: {share:.2f}", flush=True)
    for file in sorted((root / "camera-frames").glob("*/*.jpg")):
        image = to_grey(read_image(file))
        squares = cut_patches(image[len(image) // 2 :], SIZE_PX)
        found = whole.compared(np.array([look_of(square) for square in squares]))
        print(f"{file.parent.name} {file.stem}: {found.is_unlike}, rank {found.rank:.2f}, in class "
              f"{found.rank_in_class:.2f}, {found.how}", flush=True)  # fmt: skip


if __name__ == "__main__":
    main()
