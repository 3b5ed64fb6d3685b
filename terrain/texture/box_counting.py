"""Box-counting dimension of up to eight binary images at once."""

import cv2
import numpy as np

from odometry.arrays import AnyArray, ByteImage, FloatArray
from terrain.texture.kept import kept

BITS_OF_BYTE: FloatArray = np.unpackbits(
    np.arange(256, dtype=np.uint8)[:, None], axis=1, bitorder="little"
).astype(np.float64)
"""(256, 8): which bits are set in each value of a byte."""

BYTES_OF_BITS = BITS_OF_BYTE.astype(np.uint8).view(np.uint64).ravel()
"""(256,): a byte for each bit, 0 or 1; up to 255 of them add up without a carry."""
MANY = 4  # small planes that are better counted together than one by one


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
    counts = np.empty((n_sizes, len(planes), 8))
    counts[0] = bit_counts(planes)
    for size in range(1, n_sizes):
        planes = or_of_2x2(planes, f"halved {size % 2}")
        counts[size] = bit_counts(planes)
    return np.moveaxis(counts, 0, 1).reshape(*bits.shape[:-2], n_sizes, 8)


def bit_counts(planes: ByteImage) -> FloatArray:
    """Count how often each bit is set in planes (N, H, W), as (N, 8)."""
    if len(planes) >= MANY and planes[0].size < 256:
        sums = BYTES_OF_BITS[planes].reshape(len(planes), -1).sum(axis=1)
        return np.asarray(sums.view(np.uint8).reshape(-1, 8), np.float64)
    histograms = np.zeros((len(planes), 256), np.float32)
    count_bytes(planes, histograms)
    return np.asarray(histograms @ BITS_OF_BYTE)


def count_bytes(planes: ByteImage, histograms: AnyArray) -> None:
    """Add the number of pixels of each value of planes (N, H, W) to float32 (N, 256)."""
    for plane, histogram in zip(planes, histograms, strict=True):
        cv2.calcHist([plane], [0], None, [256], [0, 256], histogram, accumulate=True)


def or_of_2x2(bits: ByteImage, use: str) -> ByteImage:
    """Halve planes (N, H, W): each pixel is the OR of a 2 x 2 block, zeros beyond the edge.

    The answer is kept for `use`, see `kept`.
    """
    planes, rows, columns = bits.shape
    even: AnyArray = bits
    if rows % 2 or columns % 2:
        even = np.zeros((planes, rows + rows % 2, columns + columns % 2), np.uint8)
        even[:, :rows, :columns] = bits
    pairs = kept("pairs", (planes, even.shape[1] // 2, even.shape[2]))
    np.bitwise_or(even[:, 0::2], even[:, 1::2], out=pairs)
    halved = kept(use, (planes, even.shape[1] // 2, even.shape[2] // 2))
    np.bitwise_or(pairs[:, :, 0::2], pairs[:, :, 1::2], out=halved)
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
