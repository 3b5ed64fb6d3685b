"""Cross-validation grouped by photograph: the choice of k and the distances to expect."""

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np
from sklearn.metrics import balanced_accuracy_score
from sklearn.model_selection import StratifiedGroupKFold

from odometry.arrays import AnyArray, FloatArray, IntArray
from terrain.classification.neighbours import Neighbours, vote
from terrain.errors import PatchError

MOST_FOLDS = 5


@dataclass(frozen=True)
class CrossValidation:
    """Out-of-fold answers: each patch is judged by a classifier that never saw its photograph.

    Attributes
    ----------
    n_neighbors : int
        The k of best balanced accuracy; of equals the largest.
    rows : IntArray, shape (n,)
        The patches that were judged; all but those whose fold left a class without training.
    codes : IntArray, shape (n,)
        True classes.
    probabilities : FloatArray, shape (n, classes)
        For each fold with the k that was best on the other folds, if there are others.
    distances : FloatArray, shape (n,)
    """

    n_neighbors: int
    rows: IntArray
    codes: IntArray
    probabilities: FloatArray
    distances: FloatArray


def grouped_folds(codes: IntArray, groups: AnyArray) -> list[tuple[IntArray, IntArray]]:
    """Split into training and test indices, groups whole and classes balanced.

    There are five folds, or fewer where a class has fewer groups (at least two).

    Raises
    ------
    PatchError
        If no split leaves every class in training, because classes share their groups.
    """
    fewest = min(len(np.unique(groups[codes == c])) for c in np.unique(codes))
    splitter = StratifiedGroupKFold(min(MOST_FOLDS, fewest), shuffle=True, random_state=0)
    folds = [
        (train, test)
        for train, test in splitter.split(codes, codes, groups)
        if len(test) and len(np.unique(codes[train])) == len(np.unique(codes))
    ]
    if not folds:
        raise PatchError("no split by photograph leaves patches of every class for training")
    return folds


def cross_validate(
    neighbours: Callable[[], Neighbours],
    neighbour_counts: tuple[int, ...],
    features: FloatArray,
    codes: IntArray,
    groups: AnyArray,
) -> CrossValidation:
    """Judge every patch out of fold and choose k.

    Parameters
    ----------
    neighbours : callable
        Makes an unfitted `Neighbours`.
    neighbour_counts : tuple of int
        Candidates for k. Those above the samples of a class in a training fold are left out.
    features : FloatArray, shape (n, F)
    codes : IntArray, shape (n,)
    groups : array, shape (n,)
        At least two per class.
    """
    folds = grouped_folds(codes, groups)
    fewest = min(int(np.bincount(codes[train]).min()) for train, _ in folds)
    counts = [k for k in sorted(neighbour_counts) if k <= fewest] or [1]
    n_classes = int(codes.max()) + 1
    probabilities = np.full((len(counts), len(codes), n_classes), np.nan)
    distances = np.full(len(codes), np.nan)
    for train, test in folds:
        model = neighbours().fit(features[train], codes[train])
        labels = model.labels(features[test], counts[-1])
        distances[test] = model.distances(features[test])
        for i, k in enumerate(counts):
            probabilities[i, test] = vote(labels[:, :k], model.class_weights_)
    kept = np.sort(np.concatenate([test for _, test in folds]))
    nested = np.full((len(codes), n_classes), np.nan)
    for _, test in folds:
        others = np.setdiff1d(kept, test)
        rows = others if len(others) else kept
        nested[test] = probabilities[_best(probabilities, codes, rows), test]
    best = _best(probabilities, codes, kept)
    return CrossValidation(counts[best], kept, codes[kept], nested[kept], distances[kept])


def _best(probabilities: FloatArray, codes: IntArray, rows: IntArray) -> int:
    scores = [balanced_accuracy_score(codes[rows], p[rows].argmax(axis=1)) for p in probabilities]
    return int(np.flatnonzero(np.array(scores) == max(scores))[-1])
