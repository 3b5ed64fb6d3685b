"""How good answers are: balanced accuracy, its interval over runs, calibration, areas."""

from collections.abc import Sequence

import numpy as np

from odometry.arrays import AnyArray, BoolArray, FloatArray, IntArray

DRAWS = 1000  # of a bootstrap
CHANCE_DRAWS = 200  # of answers that are right as often as they say
INTERVAL = (0.05, 0.95)
BINS = 10  # of probability


def class_weights(labels: AnyArray) -> FloatArray:
    """Weights (N,) that add up to 1, the same for every class."""
    names, places, counts = np.unique(labels.astype(str), return_inverse=True, return_counts=True)
    return np.asarray(1 / (len(names) * counts[places]))


def balanced_accuracy(labels: AnyArray, right: BoolArray) -> float:
    """Mean over classes of the share of right answers (N,); NaN without any."""
    return float(class_weights(labels) @ right) if len(labels) else float("nan")


def bootstrap_interval(
    labels: AnyArray, right: BoolArray, runs: IntArray, seed: int = 0
) -> tuple[float, float]:
    """Balanced accuracy over runs drawn anew, within each class: 5 and 95 %.

    Parameters
    ----------
    labels, right, runs : (N,)
        Of each answer.
    """
    rng, drawn = np.random.default_rng(seed), []
    for name in np.unique(labels.astype(str)):
        of = labels.astype(str) == name
        _, places = np.unique(runs[of], return_inverse=True)
        counts = np.bincount(places).astype(float)
        good = np.bincount(places, weights=right[of].astype(float))
        rows = rng.integers(len(counts), size=(DRAWS, len(counts)))
        drawn.append(good[rows].sum(axis=1) / counts[rows].sum(axis=1))
    if not drawn:
        return float("nan"), float("nan")
    low, high = np.quantile(np.mean(drawn, axis=0), INTERVAL)
    return float(low), float(high)


def confusion(labels: AnyArray, answers: AnyArray, columns: Sequence[str]) -> IntArray:
    """Counts by true name and answer, (rows, columns); the rows are the first names."""
    names = sorted(set(labels.astype(str).tolist()))
    return np.array(
        [[np.sum((labels == name) & (answers == one)) for one in columns] for name in names]
    )


def calibration_error(labels: AnyArray, probabilities: FloatArray, names: Sequence[str]) -> float:
    """Expected calibration error of the most probable answer, with equal weights of classes.

    Mean over BINS of equal width of |share right - mean probability|.

    References
    ----------
    Naeini, Cooper and Hauskrecht 2015, eq. 3.
    """
    if not len(labels):
        return float("nan")
    right = np.array(names, dtype=object)[probabilities.argmax(axis=1)] == labels
    return _error(class_weights(labels), right, probabilities.max(axis=1))


def mean_excess(labels: AnyArray, probabilities: FloatArray, names: Sequence[str]) -> float:
    """Mean probability of the most probable answer less the share right: above 0, too sure."""
    right = np.array(names, dtype=object)[probabilities.argmax(axis=1)] == labels
    return float(class_weights(labels) @ (probabilities.max(axis=1) - right))


def error_by_chance(
    labels: AnyArray, probabilities: FloatArray, groups: AnyArray, seed: int = 0
) -> float:
    """The calibration error to expect of probabilities that are exactly right, by chance alone.

    Answers are drawn, right with their own probability; those of a group are drawn together, by
    one number, so that they are right and wrong as a whole.

    Parameters
    ----------
    labels : (N,)
        Whose classes have the same weight.
    probabilities : (N, K)
    groups : (N,)
        All different where answers are independent; runs where their windows are correlated.
    seed : int
    """
    if not len(labels):
        return float("nan")
    sure, weights = probabilities.max(axis=1), class_weights(labels)
    numbers, places = np.unique(groups, return_inverse=True)
    rng = np.random.default_rng(seed)
    drawn = [
        _error(weights, rng.random(len(numbers))[places] < sure, sure) for _ in range(CHANCE_DRAWS)
    ]
    return float(np.mean(drawn))


def _error(weights: FloatArray, right: AnyArray, sure: FloatArray) -> float:
    bins = np.minimum((sure * BINS).astype(np.int64), BINS - 1)
    off = np.bincount(bins, weights=weights * (right - sure), minlength=BINS)
    return float(np.abs(off).sum())


def area(known: FloatArray, unknown: FloatArray) -> float:
    """Share of pairs in which the unknown has the greater score; ties count half."""
    if not len(known) or not len(unknown):
        return float("nan")
    ordered = np.sort(known)
    below = np.searchsorted(ordered, unknown, side="left")
    upto = np.searchsorted(ordered, unknown, side="right")
    return float((below + upto).mean() / (2 * len(known)))
