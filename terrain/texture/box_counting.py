"""Box-counting dimension of up to eight binary images at once."""

from collections.abc import Iterable
from functools import lru_cache

import cv2
import numpy as np

from odometry.arrays import AnyArray, ByteImage, FloatArray, IntArray
from terrain.texture.borders import kept

BITS_OF_BYTE: FloatArray = np.unpackbits(
    np.arange(256, dtype=np.uint8)[:, None], axis=1, bitorder="little"
).astype(np.float64)
"""(256, 8): which bits are set in each value of a byte."""

BYTES_OF_BITS = BITS_OF_BYTE.astype(np.uint8).view(np.float64).ravel()
"""(256,): eight bytes, one for each bit, 0 or 1, held as a float64 for `cv2.LUT`."""
MOST_ADDED = 255  # as whole numbers of eight bytes so many add up without a carry
SMALL = 48  # pixels of a side; smaller images are counted together, a byte for each bit


def byte_histogram(values: ByteImage) -> FloatArray:
    """Count how often each value of a byte occurs.

    Parameters
    ----------
    values : (H, W) array of uint8

    Returns
    -------
    (256,) array of float64
        Exact up to 2^24 of one value; beyond, rounded to float32 by OpenCV.
    """
    counts: AnyArray = cv2.calcHist([values], [0], None, [256], [0, 256])
    return counts.ravel().astype(np.float64)


def box_counts(bits: ByteImage) -> FloatArray:
    """Count the boxes that hold a set pixel, for boxes of side 1, 2, 4, ...

    Parameters
    ----------
    bits : (H, W) or (N, H, W) array of uint8
        One binary image in each bit.

    Returns
    -------
    (n_sizes, 8) or (N, n_sizes, 8) array
        A row for each side, from 1 to the power of two that covers the longer side of the
        image, a column for each bit. Boxes start at the top left pixel; beyond the image is zero.
    """
    planes = bits.reshape(-1, *bits.shape[-2:])
    n_sizes = (max(bits.shape[-2:]) - 1).bit_length() + 1
    histograms = np.zeros((n_sizes, len(planes), 256), np.float32)
    large = 0
    while max(planes.shape[1:]) > SMALL:
        count_bytes(planes, histograms[large])
        planes = or_of_2x2(planes, f"halved {large % 2}")
        large += 1
    of_large = (histograms[:large] @ BITS_OF_BYTE).swapaxes(0, 1)
    counts = np.concatenate((of_large, _small_box_counts(planes, n_sizes - large)), axis=1)
    return counts.reshape(*bits.shape[:-2], n_sizes, 8)


def _small_box_counts(planes: ByteImage, n_sizes: int) -> FloatArray:
    """`box_counts` (N, n_sizes, 8) of planes of at most SMALL x SMALL pixels."""
    sizes = [planes.reshape(len(planes), -1)]
    for size in range(1, n_sizes):
        planes = or_of_2x2(planes, f"small {size}")
        sizes.append(planes.reshape(len(planes), -1))
    parts, firsts = _parts(tuple(of.shape[1] for of in sizes))
    set_bits = np.asarray(cv2.LUT(np.concatenate(sizes, axis=1), BYTES_OF_BITS)).view(np.uint64)
    sums = np.add.reduceat(set_bits, parts, axis=1).view(np.uint8)
    return np.add.reduceat(sums.reshape(len(planes), -1, 8), firsts, axis=1, dtype=np.float64)


@lru_cache(maxsize=64)  # of few sizes of images
def _parts(pixels: tuple[int, ...]) -> tuple[IntArray, IntArray]:
    """Where parts of at most MOST_ADDED of so many pixels of each size begin, side by side.

    And which part is the first of each size.
    """
    ends = np.cumsum(pixels)
    parts = [np.arange(end - of, end, MOST_ADDED) for of, end in zip(pixels, ends, strict=True)]
    firsts = np.cumsum([0, *(len(of) for of in parts[:-1])])
    return np.concatenate(parts), firsts


def count_bytes(planes: Iterable[ByteImage], histograms: AnyArray) -> None:
    """Add the number of pixels of each value of N planes (H, W) to float32 (N, 256)."""
    for plane, histogram in zip(planes, histograms, strict=True):
        cv2.calcHist([plane], [0], None, [256], [0, 256], histogram, accumulate=True)


def or_of_2x2(bits: ByteImage, use: str) -> ByteImage:
    """Halve planes (N, H, W): each pixel is the OR of a 2 x 2 block, zeros beyond the edge.

    The answer is kept for `use`, see `kept`.
    """
    planes, rows, columns = bits.shape
    pairs = kept("pairs", (planes, (rows + 1) // 2, columns + columns % 2))
    np.bitwise_or(bits[:, : rows - 1 : 2], bits[:, 1::2], out=pairs[:, : rows // 2, :columns])
    if rows % 2:
        pairs[:, -1, :columns] = bits[:, -1]
    if columns % 2:
        pairs[:, :, -1] = 0
    both = pairs.view(np.uint16)
    both |= both >> np.uint16(8)
    halved = kept(use, both.shape)
    np.copyto(halved, both, casting="unsafe")  # the lower byte
    return halved


def fractal_dimension(counts: FloatArray) -> FloatArray:
    """Give the least-squares slope of log count over log(1 / side).

    Parameters
    ----------
    counts : (..., n_sizes, n) array
        Box counts for sides 1, 2, 4, ..., as `box_counts` gives them.

    Returns
    -------
    (..., n) array
        0 for an image without set pixels, and where there is only one size.
    """
    n_sizes = counts.shape[-2]
    log_sides = np.log(2.0) * (np.arange(n_sizes) - (n_sizes - 1) / 2.0)
    weights = -log_sides / max(float(log_sides @ log_sides), 1.0e-300)
    slopes: FloatArray = weights @ np.log(np.maximum(counts, 1.0))
    return slopes
