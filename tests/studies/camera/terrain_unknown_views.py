"""Whether distances by each kind of features, beside all together, tell unknown terrain better.

    TERRAIN_ODOMETRY_DATA=... python -m tests.studies.camera.terrain_unknown_views
        [--folder pavements]

Each class of a folder is left out in turn (grey, 12 patches a photograph, five folds by
photograph, curved discriminants). The distance in use is that of one model of all features. The
other one is the geometric mean of it and of that of views: models of SFTA, of joint statistics and
of Gabor statistics alone, of which the geometric mean is taken first. Prints what is refused of
unknown terrain where 5 % of held-out known is, by patch and by 12 patches of a photograph together,
with the 95 % interval of the difference over photographs; and what is refused of known patches that
are altered.
"""

import argparse
import os
from collections.abc import Mapping
from dataclasses import dataclass
from pathlib import Path

import cv2
import numpy as np

from odometry.arrays import AnyArray, ByteImage, FloatArray, IntArray
from terrain.classification.features.feature_jobs import shared_feature_matrix
from terrain.classification.neighbours.neighbours import DiscriminantNeighbours
from terrain.classification.neighbours.validation import grouped_folds
from terrain.classification.photographs.patches import find_photos, load_patches
from terrain.classification.presets import PRESETS
from terrain.images import to_grey

SIZES = {"ground": 128, "pavements": 96}
PER_PHOTO, REJECTED, DRAWS = 12, 0.05, 400
VIEWS = (slice(0, 72), slice(72, 302), slice(302, 348))
ALTERATIONS = {
    "blur of 3 px": lambda image: cv2.GaussianBlur(image, (0, 0), 3.0),
    "gamma 2.2": lambda image: (255 * (image / 255) ** 2.2).astype(np.uint8),
    "four times as bright": lambda image: np.clip(4.0 * image, 0, 255).astype(np.uint8),
    "a tenth as bright": lambda image: (0.1 * image).astype(np.uint8),
}


@dataclass(frozen=True)
class Shown:
    """Features of patches, and the photograph of each."""

    features: FloatArray
    photos: AnyArray

    @property
    def images(self) -> list[IntArray]:
        """The patches of each photograph."""
        return [np.flatnonzero(self.photos == photo) for photo in np.unique(self.photos)]

    def only(self, rows: IntArray) -> "Shown":
        """Some of the patches."""
        return Shown(self.features[rows], self.photos[rows])


def features_of(images: list[ByteImage]) -> FloatArray:
    """Of the default preset in grey."""
    return shared_feature_matrix(
        images, PRESETS["default"].features, processes=1, show_progress=False
    )


def distances(model: DiscriminantNeighbours, shown: Shown, view: slice) -> list[FloatArray]:
    """Logarithms by patch, and by photograph."""
    alone = list(np.arange(len(shown.photos))[:, None])
    features = shown.features[:, view]
    return [
        np.log(np.maximum(model.labels_and_image_distances(features, 1, of)[1], 1e-12))
        for of in (alone, shown.images)
    ]


def both_ways(
    features: FloatArray, codes: IntArray, shown: Mapping[str, Shown]
) -> dict[str, list[list[FloatArray]]]:
    """Distances of what is shown: in use, and with views; each by patch and by photograph."""
    found = []
    for view in (slice(None), *VIEWS):
        model = DiscriminantNeighbours().fit(features[:, view], codes)
        found.append({name: distances(model, of, view) for name, of in shown.items()})
    return {
        name: [
            found[0][name],
            [
                (found[0][name][by] + np.mean([of[name][by] for of in found[1:]], axis=0)) / 2
                for by in (0, 1)
            ],
        ]
        for name in shown
    }


def refused(known: FloatArray, unknown: FloatArray) -> float:
    """Share of unknown beyond the limit of known."""
    return float(np.mean(unknown > np.quantile(known, 1 - REJECTED)))


def resampled(rng: np.random.Generator, shown: Shown) -> tuple[IntArray, IntArray]:
    """Rows of patches, and of photographs, of photographs drawn with replacement."""
    images = shown.images
    drawn = rng.integers(0, len(images), len(images))
    return np.concatenate([images[one] for one in drawn]), drawn


def differences(known: Shown, unknown: Shown, found: Mapping[str, list[list[FloatArray]]],
                rng: np.random.Generator) -> FloatArray:  # fmt: skip
    """Gains (draws, 2) by patch and by photograph of resampled photographs."""
    gains = []
    for _ in range(DRAWS):
        near, far = resampled(rng, known), resampled(rng, unknown)
        shares = [
            [refused(of[by][near[by]], off[by][far[by]]) for by in (0, 1)]
            for of, off in zip(found["known"], found["unknown"], strict=True)
        ]
        gains.append(np.subtract(shares[1], shares[0]))
    return np.array(gains)


@dataclass(frozen=True)
class Fold:
    """Refused of unknown terrain (ways, 2), the gain drawn (draws, 2), refused of altered ones."""

    shares: FloatArray
    gains: FloatArray
    altered: FloatArray


def judged(shown: Mapping[str, Shown], found: Mapping[str, list[list[FloatArray]]]) -> Fold:
    """What one fold says."""
    near, far = found["known"], found["unknown"]
    pairs = zip(near, far, strict=True)
    shares = [[refused(of[by], off[by]) for by in (0, 1)] for of, off in pairs]
    others = [[refused(near[way][0], found[how][way][0]) for way in (0, 1)] for how in ALTERATIONS]
    rng = np.random.default_rng(1)
    gains = differences(shown["known"], shown["unknown"], found, rng)
    return Fold(np.array(shares), gains, np.array(others))


def main() -> None:
    """Print shares and intervals."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--folder", choices=SIZES, default="ground")
    name = parser.parse_args().folder
    root = Path(os.environ["TERRAIN_ODOMETRY_DATA"]) / "terrain-images" / name
    patches = load_patches(find_photos(root), SIZES[name], PER_PHOTO)
    labels, groups = np.array(patches.labels), np.array(patches.groups)
    everything = Shown(features_of(patches.images), np.array([str(of) for of in patches.photos]))
    few = np.arange(0, len(labels), PER_PHOTO // 2)
    grey = [to_grey(patches.images[row]) for row in few]
    altered = {how: features_of([alter(of) for of in grey]) for how, alter in ALTERATIONS.items()}
    folds = []
    for left_out in np.unique(labels):
        known = np.flatnonzero(labels != left_out)
        codes = np.unique(labels[known], return_inverse=True)[1]
        for train, test in grouped_folds(codes, groups[known]):
            held = np.isin(few, known[test])
            shown = {how: Shown(of[held], few[held]) for how, of in altered.items()}
            shown["known"] = everything.only(known[test])
            shown["unknown"] = everything.only(np.flatnonzero(labels == left_out))
            found = both_ways(everything.features[known[train]], codes[train], shown)
            folds.append(judged(shown, found))
    low, high = np.quantile(np.mean([of.gains for of in folds], axis=0), [0.025, 0.975], axis=0)
    before, after = np.mean([of.shares for of in folds], axis=0)
    for by, what in enumerate(("patches", "photographs")):
        print(f"{what}: {before[by]:.3f} -> {after[by]:.3f}, gain [{low[by]:.3f}, {high[by]:.3f}]")
    for how, row in zip(ALTERATIONS, np.mean([of.altered for of in folds], axis=0), strict=True):
        print(f"{how}: {row[0]:.3f} -> {row[1]:.3f}")


if __name__ == "__main__":
    main()
