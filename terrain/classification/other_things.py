"""Images of things that are no terrain, such as a cat, a cup or a page of print; and squares."""

from collections.abc import Mapping
from dataclasses import dataclass
from functools import cache
from typing import Self

import cv2
import numpy as np
import skimage.data

from odometry.arrays import AnyArray, ByteImage, FloatArray, IntArray
from terrain.classification.neighbours.metric import DiscriminantMetric
from terrain.classification.neighbours.rejection import PATCHES, images_of_patches, rejection_limit
from terrain.classification.neighbours.validation import grouped_folds
from terrain.classification.no_ground import NO_GROUND
from terrain.images import to_bytes

THINGS = NO_GROUND + "like photographs of things"
PHOTOGRAPHS = ("cat", "coffee", "astronaut", "coins", "page", "text", "checkerboard")
SQUARES = 16  # of each photograph
KNOWN_SHARE, SHARE_OF_A_TERRAIN = 0.01, 0.05  # of images that may be taken for things
NO_LIMIT = np.finfo(float).max


@cache
def squares_of(photographs: tuple[str, ...], size_px: int) -> list[ByteImage]:
    """RGB squares (S, S, 3) of photographs of scikit-image, one photograph after the other.

    They are as large as the photograph shows them, twice or half as large, and turned; the same
    for each call.
    """
    rng = np.random.default_rng(0)
    squares = []
    for name in photographs:
        levels = _levels(getattr(skimage.data, name)(), size_px)
        for _ in range(SQUARES):
            level = levels[rng.integers(len(levels))]
            top, left = (int(rng.integers(length - size_px + 1)) for length in level.shape[:2])
            square = level[top : top + size_px, left : left + size_px]
            squares.append(np.ascontiguousarray(np.rot90(square, int(rng.integers(4)))))
    return squares


def _levels(photograph: AnyArray, size_px: int) -> list[ByteImage]:
    """A photograph in RGB, twice and half as large, where a square fits in."""
    image = to_bytes(photograph)
    whole = np.stack([image] * 3, axis=-1) if image.ndim == 2 else image[..., :3]
    while min(whole.shape[:2]) < size_px:
        whole = np.asarray(cv2.pyrUp(whole), np.uint8)
    levels = [cv2.pyrUp(whole), whole, cv2.pyrDown(whole)]
    return [np.asarray(level, np.uint8) for level in levels if min(level.shape[:2]) >= size_px]


@dataclass(frozen=True)
class OtherThings:
    """How features of things differ from those of terrain, and how far terrain goes that way.

    What distinguishes terrains does not show that an image is of none of them. Photographs of a few
    things stand for all others: one discriminant between them and the training patches, with
    limits by training patches alone, each judged without its photograph.

    Attributes
    ----------
    direction : FloatArray, shape (F,)
        In scaled features.
    limits : FloatArray, shape (classes, 5)
        Of the mean place along it of 1, 2, 4, 8 and 16 patches: beyond it lie 1 % of known images,
        and no more than 5 % of those of one terrain. The largest number where there are too few
        images to know.

    References
    ----------
    Hendrycks, Mazeika and Dietterich 2019, "Deep anomaly detection with outlier exposure"; limits
    as in Vovk, Gammerman and Shafer 2005, "Algorithmic learning in a random world", section 2.
    """

    direction: FloatArray
    limits: FloatArray

    @classmethod
    def of(cls, terrain: FloatArray, codes: IntArray, groups: AnyArray, things: FloatArray) -> Self:
        """Of scaled features of training patches (n, F), and of things (m, F)."""
        places = np.full(len(terrain), np.nan)
        for train, test in grouped_folds(codes, groups):
            direction, middle = _direction(terrain[train], things)
            places[test] = terrain[test] @ direction - middle
        direction, middle = _direction(terrain, things)
        held_out = np.isfinite(places)
        limits = _limits(places[held_out], codes[held_out], groups[held_out])
        return cls(direction, middle + limits)

    def include(self, scaled: FloatArray, code: int) -> bool:
        """Whether patches (m, F) of one image, named a terrain, are rather of a thing."""
        place = float((scaled @ self.direction).mean())
        return place > rejection_limit(len(scaled), self.limits[code].tolist())

    def arrays(self) -> dict[str, AnyArray]:
        """Everything learned, by name."""
        return {"things_direction": self.direction, "things_limits": self.limits}

    @classmethod
    def from_arrays(cls, arrays: Mapping[str, AnyArray], classes: int) -> Self | None:
        """Rebuild from what `arrays` gave; None of files before version 0.16, which have none.

        Raises
        ------
        KeyError, ValueError
            If the arrays do not fit.
        """
        if "things_direction" not in arrays:
            return None
        direction, limits = arrays["things_direction"], arrays["things_limits"]
        if limits.shape != (classes, len(PATCHES)) or direction.ndim != 1:
            raise ValueError(f"things have shapes {direction.shape}, {limits.shape}")
        return cls(direction, limits)


def _direction(terrain: FloatArray, things: FloatArray) -> tuple[FloatArray, float]:
    """From terrain (n, F) towards things (m, F), and the mean place of terrain along it."""
    are_things = np.repeat([0, 1], [len(terrain), len(things)])
    metric = DiscriminantMetric().fit(np.concatenate([terrain, things]), are_things)
    direction = metric.projection_[:, 0]
    middle = terrain.mean(axis=0)
    towards = np.sign((things.mean(axis=0) - middle) @ direction)
    return towards * direction, float(towards * (middle @ direction))


def _limits(places: FloatArray, codes: IntArray, groups: AnyArray) -> FloatArray:
    """Limits (classes, 5) by the places of patches that were held out (n,)."""
    limits = np.empty((int(codes.max()) + 1, len(PATCHES)))
    for column, count in enumerate(PATCHES):
        images = images_of_patches(groups, count)
        means = np.array([places[rows].mean() for rows in images])
        terrains = np.array([codes[rows[0]] for rows in images])
        of_all = _exceeded_by(means, KNOWN_SHARE)
        for code in range(len(limits)):
            own = _exceeded_by(means[terrains == code], SHARE_OF_A_TERRAIN)
            limits[code, column] = max(of_all, own)
    return np.asarray(np.minimum.accumulate(limits, axis=1))


def _exceeded_by(means: FloatArray, share: float) -> float:
    """What no more than this share of further images lies beyond."""
    rank = int(np.ceil((len(means) + 1) * (1 - share)))
    return float(np.sort(means)[rank - 1]) if rank <= len(means) else NO_LIMIT
