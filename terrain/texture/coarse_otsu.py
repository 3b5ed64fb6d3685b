"""Multilevel Otsu of many histograms at once, in fewer bins than there are greys."""

import numpy as np

from odometry.arrays import FloatArray
from terrain.texture.otsu import TIE, multilevel_otsu

TOGETHER = 16  # histograms; their scores stay in the cache
STRIP = 32
LEAST_PIXELS = 0.5  # of a class, so that an empty one adds nothing


def coarse_otsu(histograms: FloatArray, n_thresholds: int, n_bins: int) -> FloatArray:
    """Give the thresholds that maximise the variance between classes whose ends are ends of bins.

    Parameters
    ----------
    histograms : (N, 256) array
        Pixels of each grey.
    n_thresholds : int
    n_bins : int
        A divisor of 256.

    Returns
    -------
    (N, n_thresholds) array
        Last greys of bins: those of `multilevel_otsu` of the binned histogram.
    """
    width = histograms.shape[1] // n_bins
    binned = histograms.reshape(-1, n_bins, width).sum(axis=2)
    bins = np.empty((len(binned), n_thresholds))
    has_enough = np.count_nonzero(binned, axis=1) > n_thresholds
    for row in np.flatnonzero(~has_enough):
        bins[row] = multilevel_otsu(binned[row], n_thresholds)
    enough = np.flatnonzero(has_enough)
    for start in range(0, len(enough), TOGETHER):
        of = enough[start : start + TOGETHER]
        bins[of] = _of_stack(binned[of], n_thresholds)
    return np.asarray(bins * width + (width - 1))


def _of_stack(histograms: FloatArray, n_thresholds: int) -> FloatArray:
    """`multilevel_otsu` of histograms (N, k) that each have more than n_thresholds values."""
    n_bins = histograms.shape[1]
    occurs = histograms > 0
    ends = occurs.argmax(axis=1) + n_bins - 1 - occurs[:, ::-1].argmax(axis=1)
    centred = 2.0 * np.arange(n_bins) - ends[:, None]
    pixels, sums = (
        np.pad(np.cumsum(of, axis=1), ((0, 0), (1, 0))) for of in (histograms, histograms * centred)
    )
    best = _best_scores(pixels, sums, n_thresholds)
    thresholds = np.empty((len(histograms), n_thresholds))
    rows, starts = np.arange(len(histograms)), np.arange(n_bins + 1)
    end = np.full(len(histograms), n_bins)
    for n_classes in range(n_thresholds, 0, -1):
        in_class = np.maximum(pixels[rows, end, None] - pixels, LEAST_PIXELS)
        totals = best[n_classes - 1] + (sums[rows, end, None] - sums) ** 2 / in_class
        totals[starts >= end[:, None]] = -np.inf
        end = (totals >= totals.max(axis=1, keepdims=True) * (1.0 - TIE)).argmax(axis=1)
        thresholds[:, n_classes - 1] = end - 1
    return thresholds


def _best_scores(pixels: FloatArray, sums: FloatArray, n_classes: int) -> FloatArray:
    """Largest sum of S^2 / W with the first v bins in c + 1 classes, at [c, :, v]."""
    best = np.full((n_classes, *pixels.shape), -np.inf)
    best[0, :, 1:] = sums[:, 1:] ** 2 / np.maximum(pixels[:, 1:], LEAST_PIXELS)
    for start in range(1, pixels.shape[1], STRIP):
        stop = min(start + STRIP, pixels.shape[1])
        scores = (sums[:, start:stop, None] - sums[:, None, :stop]) ** 2
        in_class = pixels[:, start:stop, None] - pixels[:, None, :stop]
        scores /= np.maximum(in_class, LEAST_PIXELS)
        not_a_class = np.triu(np.ones((stop - start, stop - start), np.bool_))
        np.copyto(scores[:, :, start:], -np.inf, where=not_a_class)
        for c in range(1, n_classes):
            best[c, :, start:stop] = (scores + best[c - 1, :, None, :stop]).max(axis=2)
    return best
