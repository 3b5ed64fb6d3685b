"""Means, covariance and third moments of byte images: sums of whole numbers, exact in any order.

An exact sum does not depend on how many threads add it up, nor on the order of the pixels.
"""

from collections.abc import Sequence

import numpy as np

from odometry.arrays import ByteImage, FloatArray
from terrain.texture.box_counting import byte_histogram

EXACT = 256  # pixels: the sum of so many products of two bytes is below 2^24, exact in float32
BAND = 256  # blocks of EXACT pixels that are looked at together, at the most
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
    pixels = images[0].size
    blocks = -(-pixels // EXACT)
    table = np.zeros((len(images) + 1, blocks * EXACT), np.uint8)
    for row, image in zip(table, images, strict=False):
        row[:pixels] = image.ravel()
    table[-1, :pixels] = 1  # products with it are the sums of the images themselves
    sums = np.zeros((len(table), len(table)))
    for first in range(0, blocks, BAND):
        part = table[:, first * EXACT : (first + BAND) * EXACT].astype(np.float32)
        of_blocks = part.reshape(len(table), -1, EXACT).swapaxes(0, 1)
        sums += (of_blocks @ of_blocks.swapaxes(1, 2)).sum(axis=0, dtype=np.float64)
    means = sums[-1, :-1] / pixels
    return means, sums[:-1, :-1] / pixels - np.outer(means, means)


def third_moments(images: Sequence[ByteImage]) -> FloatArray:
    """Give the mean cubes (k,) of the deviations of k images from their means, in greys cubed."""
    histograms = np.stack([byte_histogram(image) for image in images])
    first, second, third = (histograms @ POWERS).T / histograms.sum(axis=1)
    return np.asarray(third - 3 * first * second + 2 * first**3)
