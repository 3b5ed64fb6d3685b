"""SFTA of many grey images of one size at once."""

from collections.abc import Iterator

import cv2
import numpy as np

from odometry.arrays import BoolArray, ByteImage, FloatArray
from terrain.texture.borders import framed, framed_borders, kept
from terrain.texture.box_counting import (
    BITS_OF_BYTE,
    box_counts,
    byte_histogram,
    count_bytes,
    fractal_dimension,
    or_of_2x2,
)
from terrain.texture.ttbd import GREYS, Variant, packed_tables

BAND = 2**19  # pixels of one image that are looked at together, at the most
TOGETHER = 2**16  # pixels of several small ones: what is made of them stays in the cache


def stack_features(greys: ByteImage, n_thresholds: int, definition: Variant) -> FloatArray:
    """Give the SFTA features of each image of a stack, as `terrain.texture.sfta` does of one.

    Parameters
    ----------
    greys : (N, H, W) array of uint8
    n_thresholds : int
    definition : Variant

    Returns
    -------
    (N, 3 n_images) array
    """
    histograms = np.stack([byte_histogram(grey) for grey in greys])
    thresholds = np.stack([definition.thresholds(of, n_thresholds) for of in histograms])
    return features_between(greys, histograms, thresholds, definition)


def features_between(
    greys: ByteImage, histograms: FloatArray, thresholds: FloatArray, definition: Variant
) -> FloatArray:
    """The same with thresholds (N, n_t) that were found before, in histograms (N, 256)."""
    members = definition.members(thresholds)
    features = np.empty((*members.shape[:2], 3))
    for j, tables in enumerate(packed_tables(members).swapaxes(0, 1)):
        eight = slice(8 * j, 8 * j + 8)
        boxes, of_borders = _boxes(greys, tables, of_borders=definition.of_borders)
        if of_borders is None:
            pixels = _region_pixels(histograms, members[:, eight])
        else:
            pixels = of_borders[:, : members[:, eight].shape[1]]
        counts, sums = pixels[..., 0], pixels[..., 1]
        features[:, eight, 0] = fractal_dimension(boxes)[:, : counts.shape[1]]
        features[:, eight, 1] = counts
        features[:, eight, 2] = sums / np.maximum(counts, 1.0)
    return features.reshape(len(greys), -1)


def _region_pixels(histograms: FloatArray, members: BoolArray) -> FloatArray:
    """Number of the pixels of each binary image and sum of their greys, (N, n, 2)."""
    weighted = np.stack([histograms, histograms * GREYS], axis=-1)
    return np.asarray(members.astype(np.float64) @ weighted)  # of whole numbers: exact


def _boxes(
    greys: ByteImage, tables: ByteImage, *, of_borders: bool
) -> tuple[FloatArray, FloatArray | None]:
    """Box counts (N, n_sizes, 8) of the borders of eight binary images of each plane.

    Where wanted, also the number of pixels of the borders and the sum of their greys, (N, 8, 2).
    """
    planes, rows, columns = greys.shape
    histograms = np.zeros((planes, 256), np.float32)
    halved = kept("halved", (planes, (rows + 1) // 2, (columns + 1) // 2))
    joint = np.zeros((planes if of_borders else 0, 256, 256), np.float32)
    for of, band, borders in _borders(greys, tables):
        count_bytes(borders, histograms[of])
        halved[of, band.start // 2 : (band.stop + 1) // 2] = or_of_2x2(borders, "halved band")
        for counts, grey, border in zip(joint[of], greys[of, band], borders, strict=False):
            cv2.calcHist(
                [grey, border], [0, 1], None, [256, 256], [0, 256, 0, 256], counts, accumulate=True
            )
    higher = box_counts(halved) if max(rows, columns) > 1 else np.empty((planes, 0, 8))
    boxes = np.concatenate(((histograms @ BITS_OF_BYTE)[:, None], higher), axis=1)
    if not of_borders:
        return boxes, None
    by_grey = joint @ BITS_OF_BYTE  # (N, 256, 8)
    return boxes, np.stack([by_grey.sum(axis=1), GREYS @ by_grey], axis=-1)


def _borders(greys: ByteImage, tables: ByteImage) -> Iterator[tuple[slice, slice, ByteImage]]:
    """Borders of eight binary images of each plane: which planes and rows, and their borders."""
    planes, rows, columns = greys.shape
    high = rows if rows * columns <= BAND else max(BAND // columns // 2 * 2, 2)
    for band in _slices(rows, high):
        top, bottom = max(band.start - 1, 0), min(band.stop + 1, rows)  # with their neighbours
        first = top - band.start + 1
        for of in _slices(planes, max(TOGETHER // (high * columns), 1)):
            padded = framed(of.stop - of.start, band.stop - band.start, columns)
            seen = padded[:, first : first + bottom - top, 1:-1]
            for bits, grey, table in zip(seen, greys[of, top:bottom], tables[of], strict=True):
                cv2.LUT(grey, table, bits)
            yield of, band, framed_borders(padded)


def _slices(count: int, length: int) -> Iterator[slice]:
    for start in range(0, count, length):
        yield slice(start, min(start + length, count))
