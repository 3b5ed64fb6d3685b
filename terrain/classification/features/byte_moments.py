"""Means, covariance and third moments of byte images: sums of whole numbers, exact in any order.

An exact sum does not depend on how many threads add it up, nor on the order of the pixels.
"""

from collections.abc import Sequence

import cv2
import numpy as np

from odometry.arrays import ByteImage, FloatArray
from terrain.texture.borders import kept
from terrain.texture.box_counting import count_bytes

MIDDLE = 128  # grey: a byte less it is at most as large
EXACT = 768  # pixels: the sum of so many products of two such is below 2^24, exact in float32
BAND = 85 * EXACT  # pixels that are looked at together, at the most
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
    flat = np.stack(images).reshape(len(images), -1)
    pixels = flat.shape[1]
    sums, products = np.zeros(len(flat)), np.zeros((len(flat), len(flat)))
    for first in range(0, pixels, BAND):
        band = flat[:, first : first + BAND]
        sums += cv2.reduce(band, 1, cv2.REDUCE_SUM, dtype=cv2.CV_32S)[:, 0]
        products += _products(band)
    # (a - m)(b - m) = a b - m a - m b + m^2, in whole numbers: exact
    products += MIDDLE * (sums[:, None] + sums - MIDDLE * pixels)
    means = sums / pixels
    return means, products / pixels - np.outer(means, means)


def _products(band: ByteImage) -> FloatArray:
    """Sums (k, k) of products of bytes (k, n), each less the MIDDLE."""
    images, pixels = band.shape
    padded = -(-pixels // EXACT) * EXACT
    table = kept("moments", (padded, 4 * images)).view(np.float32)
    by_pixel: ByteImage = np.asarray(cv2.transpose(band), np.uint8)
    table[:pixels] = (by_pixel ^ np.uint8(MIDDLE)).view(np.int8)
    table[pixels:] = 0
    blocks = table.reshape(-1, EXACT, images)  # pixel by pixel: products take less time
    return np.asarray((blocks.swapaxes(1, 2) @ blocks).sum(axis=0, dtype=np.float64))


def third_moments(images: Sequence[ByteImage]) -> FloatArray:
    """Give the mean cubes (k,) of the deviations of k images from their means, in greys cubed."""
    histograms = np.zeros((len(images), 256), np.float32)
    count_bytes(images, histograms)
    first, second, third = (histograms @ POWERS).T / images[0].size
    return np.asarray(third - 3 * first * second + 2 * first**3)
