"""Box-counting dimension of up to eight binary images at once."""

import cv2
import numpy as np

from odometry.arrays import AnyArray, ByteImage, FloatArray

BITS_OF_BYTE: FloatArray = np.unpackbits(
    np.arange(256, dtype=np.uint8)[:, None], axis=1, bitorder="little"
).astype(np.float64)
"""(256, 8): which bits are set in each value of a byte."""


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
    bits : (H, W) array of uint8
        One binary image in each bit.

    Returns
    -------
    (n_sizes, 8) array
        A row for each side, from 1 to the power of two that covers the longer side of the
        image, a column for each bit. Boxes start at the top left pixel; beyond the image is zero.
    """
    n_sizes = (max(bits.shape) - 1).bit_length() + 1
    histograms = np.empty((n_sizes, 256))
    histograms[0] = byte_histogram(bits)
    for size in range(1, n_sizes):
        bits = _or_of_2x2(bits)
        histograms[size] = byte_histogram(bits)
    return histograms @ BITS_OF_BYTE


def _or_of_2x2(bits: ByteImage) -> ByteImage:
    """Halve the image: each pixel is the OR of a 2 x 2 block, zeros beyond the edge."""
    odd = (bits.shape[0] % 2, bits.shape[1] % 2)
    even: AnyArray = bits
    if any(odd):
        even = cv2.copyMakeBorder(bits, 0, odd[0], 0, odd[1], cv2.BORDER_CONSTANT, value=0)
    pairs = (even[0::2] | even[1::2]).view(np.uint16)  # two neighbours of a row
    pairs |= pairs >> np.uint16(8)
    return pairs.astype(np.uint8)


def fractal_dimension(counts: FloatArray) -> FloatArray:
    """Give the least-squares slope of log count over log(1 / side).

    Parameters
    ----------
    counts : (n_sizes, n) array
        Box counts for sides 1, 2, 4, ..., as `box_counts` gives them.

    Returns
    -------
    (n,) array
        0 for an image without set pixels, and where there is only one size.
    """
    n_sizes = counts.shape[0]
    log_sides = np.log(2.0) * (np.arange(n_sizes) - (n_sizes - 1) / 2.0)
    weights = -log_sides / max(float(log_sides @ log_sides), 1.0e-300)
    slopes: FloatArray = weights @ np.log(np.maximum(counts, 1.0))
    return slopes
