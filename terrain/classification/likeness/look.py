"""Numbers that say how an image looks: exposure, sharpness, scale and compression."""

from collections.abc import Sequence
from functools import lru_cache
from itertools import pairwise

import cv2
import numpy as np

from odometry.arrays import AnyArray, ByteImage, FloatArray, IntArray
from terrain.classification.features.filters import latest_scales
from terrain.classification.photographs.patches import cut_patches
from terrain.images import to_grey

NUMBERS = 7  # of a look; files before version 0.14 have the first six
SIGMAS_PX = (0.7, 1.4, 2.8, 5.6, 11.2)  # between two of them lies an octave of texture
PATCHES_PER_PHOTO = 12
MOST_PATCHES = 2000
KEPT = 16  # looks: a run asks for that of a patch twice, for its answer and for the run as a whole


def look_of(patch: ByteImage) -> FloatArray:
    """Seven numbers (7,) of a patch: mean grey, contrast, how octaves compare, and compression.

    The mean is in units of white, the others are natural logarithms: of the deviation of grey, of
    the variance of an octave over that of the next coarser one, finest first, and of the median
    size of the finest octave over its deviation, which compression sets to zero in most places.
    """
    return _look(patch.tobytes(), patch.shape)


@lru_cache(maxsize=KEPT)
def _look(content: bytes, shape: tuple[int, ...]) -> FloatArray:
    patch = np.frombuffer(content, dtype=np.uint8).reshape(shape)
    scales = latest_scales(to_grey(patch))
    levels = [scales.grey, *(scales.blurred(sigma) for sigma in SIGMAS_PX)]
    spreads = [cv2.meanStdDev(a - b)[1].item() for a, b in pairwise(levels)]
    octaves = np.log(np.square(spreads) + 0.05)
    finest = np.sort(np.abs(levels[0] - levels[1]), axis=None)  # a median takes longer
    median = finest[[(finest.size - 1) // 2, finest.size // 2]].mean()
    usual = np.log((median + 0.1) / (np.sqrt(np.mean(finest**2)) + 0.1))
    mean, deviation = (of.item() for of in cv2.meanStdDev(levels[0]))
    exposure = [mean / 255, np.log(deviation + 1)]
    look = np.array([*exposure, *(octaves[:-1] - octaves[1:]), usual])
    look.flags.writeable = False
    return look


def middle_of(image: ByteImage, size_px: int) -> ByteImage:
    """The square in the middle of an image; smaller where the image is."""
    top, left = (max(0, (length - size_px) // 2) for length in image.shape[:2])
    return image[top : top + size_px, left : left + size_px]


def looks_of(image: ByteImage, size_px: int) -> FloatArray:
    """Looks (m, 7) of at most 12 patches, spread evenly, or of an image that is smaller."""
    patches = cut_patches(image, size_px) or [image]
    few = np.linspace(0, len(patches) - 1, min(len(patches), PATCHES_PER_PHOTO)).astype(int)
    return np.array([look_of(patches[i]) for i in few])


def spread_patches(
    patches: Sequence[ByteImage], codes: IntArray, groups: AnyArray
) -> tuple[list[ByteImage], IntArray, AnyArray]:
    """Patches of `spread_rows`, with their terrains (n,) and photographs (n,)."""
    rows = spread_rows(groups)
    return [patches[row] for row in rows], codes[rows], groups[rows]


def spread_rows(groups: AnyArray) -> IntArray:
    """Rows of at most 12 patches of each photograph, spread evenly, and 2000 in all."""
    rows: list[int] = []
    for group in dict.fromkeys(groups.tolist()):
        of = np.flatnonzero(groups == group)
        count = min(len(of), PATCHES_PER_PHOTO)
        rows += of[np.linspace(0, len(of) - 1, count).astype(int)].tolist()
    kept = np.linspace(0, len(rows) - 1, min(len(rows), MOST_PATCHES)).astype(int)
    return np.asarray(np.array(rows, dtype=np.intp)[kept])
