"""Multilevel Otsu of many histograms at once, in fewer bins than there are greys."""

import numpy as np

from odometry.arrays import FloatArray
from terrain.texture.otsu import TIE, multilevel_otsu

TOGETHER = 80  # histograms; their scores stay in the cache
FEW = 8  # histograms; fewer are faster one by one
STRIP = 6
NOT_BEFORE = np.triu(np.ones((STRIP, STRIP), np.bool_))
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
    in_stack = (np.count_nonzero(binned, axis=1) > n_thresholds) & (len(binned) >= FEW)
    for row in np.flatnonzero(~in_stack):
        bins[row] = multilevel_otsu(binned[row], n_thresholds)
    stacked = np.flatnonzero(in_stack)
    for start in range(0, len(stacked), TOGETHER):
        of = stacked[start : start + TOGETHER]
        bins[of] = _of_stack(binned[of], n_thresholds)
    return np.asarray(bins * width + (width - 1))


def _of_stack(histograms: FloatArray, n_thresholds: int) -> FloatArray:
    """`multilevel_otsu` of histograms (N, k) that each have more than n_thresholds values."""
    n_bins = histograms.shape[1]
    occurs = histograms > 0
    ends = occurs.argmax(axis=1) + n_bins - 1 - occurs[:, ::-1].argmax(axis=1)
    centred = 2.0 * np.arange(n_bins) - ends[:, None]
    pixels, sums = np.zeros((2, n_bins + 1, len(histograms)))
    np.cumsum(histograms.T, axis=0, out=pixels[1:])
    np.cumsum((histograms * centred).T, axis=0, out=sums[1:])
    best = _best_scores(pixels, sums, n_thresholds)
    thresholds = np.empty((len(histograms), n_thresholds))
    each, starts = np.arange(len(histograms)), np.arange(n_bins + 1)[:, None]
    end = np.full(len(histograms), n_bins)
    for n_classes in range(n_thresholds, 0, -1):
        in_class = np.maximum(pixels[end, each] - pixels, LEAST_PIXELS)
        totals = best[n_classes - 1] + (sums[end, each] - sums) ** 2 / in_class
        totals[starts >= end] = -np.inf
        end = (totals >= np.maximum.reduce(totals, axis=0) * (1.0 - TIE)).argmax(axis=0)
        thresholds[:, n_classes - 1] = end - 1
    return thresholds


def _best_scores(pixels: FloatArray, sums: FloatArray, n_classes: int) -> FloatArray:
    """Largest sum of S^2 / W with the first v bins in c + 1 classes, at [c, v, :].

    The histograms lie side by side in the last axis of pixels and sums (k + 1, N).
    """
    best = np.full((n_classes, *pixels.shape), -np.inf)
    best[0, 1:] = sums[1:] ** 2 / np.maximum(pixels[1:], LEAST_PIXELS)
    for start in range(1, len(pixels), STRIP):
        stop = min(start + STRIP, len(pixels))
        in_class = pixels[start:stop, None] - pixels[:stop]
        np.maximum(in_class, LEAST_PIXELS, out=in_class)
        scores = sums[start:stop, None] - sums[:stop]
        scores *= scores
        scores /= in_class
        scores[:, start:][NOT_BEFORE[: stop - start, : stop - start]] = -np.inf
        for c in range(1, n_classes):
            totals = np.add(scores, best[c - 1, :stop], out=in_class)
            np.maximum.reduce(totals, axis=1, out=best[c, start:stop])
    return best
