"""Pieces of one photograph: images of one size that continue each other across a border."""

from collections import defaultdict
from collections.abc import Iterator, Mapping
from pathlib import Path

import cv2
import numpy as np
from scipy import ndimage

from odometry.arrays import AnyArray, FloatArray

SMOOTH_PX = 17  # brightness that changes over more is left out: it is alike in many photographs
CONTINUES = 0.75  # correlation above; the largest of two million borders of other scenes is 0.73
NOISE_GREYS = 2.0  # standard deviation: texture that is much weaker is noise
LEAST = 0.3  # standard deviation, in units of the local one, below which a border is even
BLACK, MOST_BLACK = 10, 0.1  # grey level, and share of a border: black bars of two images are alike
SHORTEST_PX = 96  # side of an image: shorter borders are alike by chance
# Of one photograph and of the next one: last and first column, then last and first row
SIDES = (((slice(None), -1), (slice(None), 0)), ((-1, slice(None)), (0, slice(None))))


def pieces(group_of: Mapping[Path, str]) -> Iterator[tuple[Path, Path]]:
    """Photographs whose right or lower border goes on in another of its size.

    Parameters
    ----------
    group_of : mapping of Path to str
        The group of each photograph: those of one are not compared. Those that are not read
        continue none.

    Yields
    ------
    (Path, Path)
        Each photograph with the one that continues it best.
    """
    of_shape: dict[tuple[int, ...], list[Path]] = defaultdict(list)
    borders: dict[Path, list[tuple[FloatArray, FloatArray]]] = {}
    for photo in group_of:
        image = cv2.imread(str(photo), cv2.IMREAD_GRAYSCALE | cv2.IMREAD_IGNORE_ORIENTATION)
        if image is not None and min(image.shape) >= SHORTEST_PX:
            of_shape[image.shape].append(photo)
            borders[photo] = [(_line(image[end]), _line(image[start])) for end, start in SIDES]
    for photos in of_shape.values():
        group = np.unique([group_of[photo] for photo in photos], return_inverse=True)[1]
        for side in range(len(SIDES)):
            ends, starts = (np.stack([borders[p][side][of] for p in photos]) for of in (0, 1))
            alike = ends @ starts.T
            alike[group[:, None] == group] = -1.0
            for one in np.flatnonzero(alike.max(axis=1) > CONTINUES):
                yield photos[int(one)], photos[int(alike[one].argmax())]


def _line(border: AnyArray) -> FloatArray:
    """A border (n,) without what is smooth, of length one; zero where it is even, or black.

    It is divided by its local standard deviation, so that one strong edge counts no more than fine
    texture: parts of the robot end at the same place in all images.
    """
    values = border.astype(np.float64)
    values -= ndimage.uniform_filter1d(values, SMOOTH_PX)
    values /= np.sqrt(ndimage.uniform_filter1d(values**2, SMOOTH_PX) + NOISE_GREYS**2)
    length = float(np.linalg.norm(values))
    shows = length > LEAST * np.sqrt(values.size) and np.mean(border < BLACK) < MOST_BLACK
    return values / length if shows else np.zeros_like(values)
