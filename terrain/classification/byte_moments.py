"""Means, covariance and third moments of byte images: sums of whole numbers, exact in any order.

An exact sum does not depend on how many threads add it up, nor on the order of the pixels.
"""

from collections.abc import Sequence

import numpy as np

from odometry.arrays import ByteImage, FloatArray
from terrain.texture.box_counting import count_bytes

EXACT = 256  # pixels: the sum of so many products of two bytes is below 2^24, exact in float32
BAND = 256 * EXACT  # pixels that are looked at together, at the most
POWERS = np.arange(256.0)[:, None] ** (1, 2, 3)


def byte_moments(images: Sequence[ByteImage]) -> tuple[FloatArray, FloatArray]:
    """Give the means and the covariance of images over their pixels.

    Parameters
    ----------
    images : sequence of k arrays (rows, columns) of uint8
        Of one size.

    Returns
    -------
    means : (k,) array
        In greys.
    covariance : (k, k) array
        In greys squared; divided by the number of pixels.
    """
    flat = [image.ravel() for image in images]
    pixels = flat[0].size
    sums = np.zeros((len(flat) + 1, len(flat) + 1))
    for first in range(0, pixels, BAND):
        of_band = min(BAND, pixels - first)
        table = np.zeros((len(flat) + 1, -(-of_band // EXACT) * EXACT), np.float32)
        for row, image in zip(table, flat, strict=False):
            row[:of_band] = image[first : first + BAND]
        table[-1, :of_band] = 1  # products with it are the sums of the images themselves
        of_blocks = table.reshape(len(table), -1, EXACT).swapaxes(0, 1)
        sums += (of_blocks @ of_blocks.swapaxes(1, 2)).sum(axis=0, dtype=np.float64)
    means = sums[-1, :-1] / pixels
    return means, sums[:-1, :-1] / pixels - np.outer(means, means)


def third_moments(images: Sequence[ByteImage]) -> FloatArray:
    """Give the mean cubes (k,) of the deviations of k images from their means, in greys cubed."""
    histograms = np.zeros((len(images), 256), np.float32)
    count_bytes(images, histograms)
    first, second, third = (histograms @ POWERS).T / images[0].size
    return np.asarray(third - 3 * first * second + 2 * first**3)
