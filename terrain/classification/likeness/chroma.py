"""How much colour an image shows beyond one tint: what red and blue do that green does not say."""

from collections.abc import Iterator

import cv2
import numpy as np

from odometry.arrays import AnyArray, ByteImage, FloatArray

GRIDS = (None, 24, 8)  # of all pixels, and of the means of so many squares a side
CHROMA_NUMBERS = 3 * len(GRIDS)
CLIPPED = 252  # a channel that is full says nothing of the others, compression spreads it
LEAST_UNCLIPPED = 0.25
COLOUR_FLOOR, GREEN_FLOOR = 0.1, 0.5  # greys: nothing has no logarithm


def chroma_of(image: ByteImage) -> FloatArray:
    """Nine numbers (9,) of an image (H, W, 3): logarithms of deviations, in greys.

    Of each grid the largest and the smallest deviation of red and blue about the line that they
    follow with green, and the deviation of green. Grey times a tint stays on its line.
    """
    return np.array([number for kept in unclipped(image) for number in _deviations(kept)])


def unclipped(image: ByteImage) -> Iterator[AnyArray]:
    """Red, green and blue (n, 3) of each grid of an image (H, W, 3), without what is clipped."""
    pixels: AnyArray = image.astype(np.float32)
    clipped: AnyArray = (image.max(axis=2) >= CLIPPED).astype(np.float32)
    for side in GRIDS:
        here, full = pixels, clipped
        if side is not None:
            size = side, side
            here, full = (
                np.asarray(cv2.resize(of, size, interpolation=cv2.INTER_AREA))
                for of in (pixels, clipped)
            )
        used = full == 0
        yield here[used] if used.mean() >= LEAST_UNCLIPPED else here.reshape(-1, 3)


def _deviations(kept: AnyArray) -> list[float]:
    """The three numbers of one grid."""
    centred = (kept - kept.mean(axis=0)).astype(np.float64)
    covariance = centred.T @ centred / len(centred)
    with_green = covariance[[0, 2], 1]
    others = covariance[np.ix_([0, 2], [0, 2])]
    beyond = others - np.outer(with_green, with_green) / (covariance[1, 1] + 1e-6)
    least, most = np.sqrt(np.maximum(np.linalg.eigvalsh(beyond), 0)).tolist()
    colours = np.array([most, least]) + COLOUR_FLOOR
    green = np.sqrt(covariance[1, 1]) + GREEN_FLOOR
    return [float(number) for number in np.log([*colours, green])]
