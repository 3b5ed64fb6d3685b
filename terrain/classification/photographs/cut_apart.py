"""Photographs that continue each other across a border: squares that one photograph was cut to."""

from collections import defaultdict
from collections.abc import Iterator, Mapping
from pathlib import Path

import cv2
import numpy as np
from scipy import ndimage

from odometry.arrays import AnyArray, FloatArray

SMOOTH_PX = 17  # what is wider says little: borders of two photographs may darken alike
CONTINUES = 0.75  # correlation; of two million borders of other scenes in development 0.73
NOISE_GREYS = 2.0  # standard deviation that says nothing
LEAST = 0.3  # standard deviation of a border that shows anything, once edges are levelled
BLACK, MOST_BLACK = 10, 0.1  # greys, and the share of a border: bars end at the same place
SHORTEST_PX = 96  # side: shorter borders are alike by chance
SIDES = (((slice(None), -1), (slice(None), 0)), ((-1, slice(None)), (0, slice(None))))


def cut_apart(group_of: Mapping[Path, str]) -> Iterator[tuple[Path, Path]]:
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
    """A border (n,) of length one, without what is smooth; zero where it is even, or black.

    Edges count no more than fine texture: parts of the robot end at the same place in each image.
    """
    values = border.astype(np.float64)
    values -= ndimage.uniform_filter1d(values, SMOOTH_PX)
    values /= np.sqrt(ndimage.uniform_filter1d(values**2, SMOOTH_PX) + NOISE_GREYS**2)
    length = float(np.linalg.norm(values))
    shows = length > LEAST * np.sqrt(values.size) and np.mean(border < BLACK) < MOST_BLACK
    return values / length if shows else np.zeros_like(values)
