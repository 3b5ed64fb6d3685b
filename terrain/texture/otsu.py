"""Thresholds of a grey histogram: exact multilevel Otsu, and the recursive split of SFTA's code."""

import numpy as np

from odometry.arrays import FloatArray

TIE = 1e-12  # relative to the largest between-class sum: below this, two choices are equal
STRIP = 64
NO_CLASS = np.where(np.tri(STRIP, dtype=np.bool_), np.inf, 0.0)  # one that ends before it begins


def multilevel_otsu(histogram: FloatArray, n_thresholds: int) -> FloatArray:
    """Give the thresholds that maximise the variance between classes, exactly.

    Class i holds the greys g with T(i) < g <= T(i + 1). Maximising the variance between the
    classes minimises the variance within them. A dynamic programme over the k greys that occur
    needs n_thresholds k^2 steps.

    Parameters
    ----------
    histogram : (256,) array
        Pixels of each grey.
    n_thresholds : int
        At least 1.

    Returns
    -------
    (n_thresholds,) array
        Greys that occur in the image, increasing. Ties: among the best sets the one with the
        smallest last threshold, then the smallest last but one, and so on; sums that differ by
        less than 1e-12 of their size count as equal. Too few greys: with k <= n_thresholds
        greys each is a class of its own, the thresholds are the k greys and the largest is
        repeated.

    References
    ----------
    Liao, Chen and Chung 2001, "A fast algorithm for multilevel thresholding": the sum over
    classes of S^2 / W is maximised (their eq. 17), S the sum of greys and W the pixels. Yao 1980,
    "Efficient dynamic programming using quadrangle inequalities".
    """
    greys = np.flatnonzero(histogram)
    if greys.size <= n_thresholds:
        return np.pad(greys, (0, n_thresholds - greys.size), mode="edge").astype(np.float64)
    # Greys from the middle of their range: small numbers, and the same ones for a shifted image.
    centred = 2.0 * greys - (greys[0] + greys[-1])
    pixels = np.concatenate(([0.0], np.cumsum(histogram[greys])))
    sums = np.concatenate(([0.0], np.cumsum(histogram[greys] * centred)))
    best = _best_scores(pixels, sums, n_thresholds)

    thresholds = np.empty(n_thresholds)
    end = greys.size
    for n_classes in range(n_thresholds, 0, -1):
        last_class = (sums[end] - sums[:end]) ** 2 / (pixels[end] - pixels[:end])
        totals = best[n_classes - 1, :end] + last_class
        end = int(np.argmax(totals >= totals.max() * (1.0 - TIE)))
        thresholds[n_classes - 1] = greys[end - 1]
    return thresholds


def _best_scores(pixels: FloatArray, sums: FloatArray, n_classes: int) -> FloatArray:
    """Largest sum of S^2 / W with the first v greys in c + 1 classes, at [c, v].

    A strip of v at a time: its scores stay in the cache while they serve every c. S^2 / W has the
    inverse quadrangle inequality, so that the best last class of more greys begins no earlier
    than that of fewer: the next strip tests no earlier beginning than that at the end of one.
    """
    best = np.full((n_classes, pixels.size), -np.inf)
    best[0, 1:] = sums[1:] ** 2 / pixels[1:]
    begins = [0] * n_classes  # of the best last class, by c
    for start in range(1, pixels.size if n_classes > 1 else 0, STRIP):
        stop, first = min(start + STRIP, pixels.size), begins[1]
        no_class = NO_CLASS[: stop - start, : stop - start]
        weights = pixels[start:stop] - pixels[first:stop, None]
        weights[start - first :] += no_class
        scores = sums[start:stop] - sums[first:stop, None]
        scores *= scores
        scores /= weights
        scores[start - first :] -= no_class
        for c in range(1, n_classes):
            totals = scores[begins[c] - first :] + best[c - 1, begins[c] : stop, None]
            np.maximum.reduce(totals, axis=0, out=best[c, start:stop])
            begins[c] += int(totals[:, -1].argmax())
    return best


def recursive_otsu(histogram: FloatArray, n_thresholds: int) -> FloatArray:
    """Give the thresholds of SFTA's published code: split in two, then split the halves.

    Parameters
    ----------
    histogram : (256,) array
        Pixels of each grey.
    n_thresholds : int
        At least 1.

    Returns
    -------
    (n_thresholds,) array
        In units of grey, with fractions; above 4 thresholds they need not increase. Where a
        part cannot be split further its thresholds are 0 or next to each other, as published.

    References
    ----------
    Costa, Humpire-Mamani and Traina 2012, and the authors' published program.
    """
    thresholds = np.zeros(n_thresholds)

    def split(low: float, high: float, first: int, last: int) -> None:
        if last < first or low >= high:
            return
        level = low + _two_class_position(histogram[int(np.ceil(low)) - 1 : int(np.ceil(high))])
        middle = (first + last + 1) // 2
        thresholds[middle - 1] = level * 255.0 / 256.0
        split(low, level, first, middle - 1)
        split(level + 1.0, high, middle + 1, last)

    split(1.0, 256.0, 1, n_thresholds)  # bins and places count from 1, as in the program
    return thresholds


def _two_class_position(histogram: FloatArray) -> float:
    """Place (from 1) of the largest between-class variance, the mean place of ties, else 0."""
    pixels = np.cumsum(histogram)
    sums = np.cumsum(histogram * np.arange(1.0, histogram.size + 1.0))
    separates = (pixels > 0.0) & (pixels < pixels[-1])
    if not separates.any():
        return 0.0
    places = np.flatnonzero(separates)
    below, total = pixels[places], pixels[-1]
    variances = (sums[-1] * below - total * sums[places]) ** 2 / (below * (total - below))
    return float(places[variances == variances.max()].mean()) + 1.0
