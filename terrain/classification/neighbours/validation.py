"""Cross-validation grouped by photograph: the choice of k and the distances to expect."""

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from typing import NamedTuple

import numpy as np
from sklearn.model_selection import StratifiedGroupKFold

from odometry.arrays import AnyArray, FloatArray, IntArray
from terrain.classification.neighbours.calibration import fitted_temperature, tempered
from terrain.classification.neighbours.metric import equal_shares
from terrain.classification.neighbours.neighbours import Neighbours, vote
from terrain.classification.neighbours.rejection import PATCHES, images_of_patches
from terrain.errors import PatchError

MOST_FOLDS = 5


@dataclass(frozen=True)
class CrossValidation:
    """Out-of-fold answers: each patch is classified by one that was trained without its photograph.

    Attributes
    ----------
    n_neighbors : int
        The k of best balanced accuracy; the largest of several equal ones.
    rows : IntArray, shape (n,)
        The patches that were held out; all but those whose fold left a class without training.
    codes : IntArray, shape (n,)
        True classes.
    probabilities : FloatArray, shape (n, classes)
        For each fold with the k that was best on the other folds, if there are others.
    distances : FloatArray, shape (n,)
    temperature : float or None
        Of the votes, as `calibration.tempered` takes it; for each fold the probabilities are those
        at the temperature of the other folds. None where votes are left as they are.
    image_distances : tuple of FloatArray, length 5
        Distances of parts of photographs, of 1, 2, 4, 8 and 16 patches that are judged together;
        see `rejection.images_of_patches`.
    """

    n_neighbors: int
    rows: IntArray
    codes: IntArray
    probabilities: FloatArray
    distances: FloatArray
    temperature: float | None = None
    image_distances: tuple[FloatArray, ...] = ()


@dataclass(frozen=True)
class Samples:
    """What is learned from: features (n, F), class codes (n,) and groups (n,)."""

    features: FloatArray
    codes: IntArray
    groups: AnyArray

    def with_copies(
        self, rows: IntArray, copies: "Samples | None"
    ) -> tuple[FloatArray, IntArray, int, FloatArray]:
        """Features and codes of some rows, then of the copies of their groups, and how many.

        Last what each counts for, see `equal_shares`.
        """
        features, codes, groups = self.features[rows], self.codes[rows], self.groups[rows]
        if copies is None:
            return features, codes, 0, equal_shares(codes, groups)
        follow = np.isin(copies.groups, groups)
        features = np.concatenate([features, copies.features[follow]])
        codes = np.concatenate([codes, copies.codes[follow]])
        groups = np.concatenate([groups, copies.groups[follow]])
        return features, codes, int(follow.sum()), equal_shares(codes, groups)


class Fold(NamedTuple):
    """A model, the rows that it was trained on, and those that were held out."""

    train: IntArray
    test: IntArray
    model: Neighbours


def balanced_accuracy(codes: IntArray, answers: IntArray) -> float:
    """Mean over the classes in `codes` (n,) of the share that is answered rightly.

    As scikit-learn's `balanced_accuracy_score`, bit by bit, which takes a hundred times as long.
    """
    counts = np.bincount(codes)
    right = np.bincount(codes[codes == answers], minlength=len(counts))
    return float(np.mean(right[counts > 0] / counts[counts > 0]))


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


def fitted_folds(
    neighbours: Callable[[], Neighbours], samples: Samples, copies: Samples | None = None
) -> list[Fold]:
    """A model for each of `grouped_folds`, trained on copies where their group is as well."""
    return [
        Fold(train, test, neighbours().fit(*samples.with_copies(train, copies)))
        for train, test in grouped_folds(samples.codes, samples.groups)
    ]


def best_way(
    ways: Sequence[Callable[[], Neighbours]],
    neighbour_counts: tuple[int, ...],
    samples: Samples,
    copies: Samples | None = None,
    *,
    calibrates: bool = False,
) -> tuple[Callable[[], Neighbours], CrossValidation, list[Fold]]:
    """The option of best balanced accuracy by `cross_validate`, the first of equal ones.

    These are a little too good where ways are close: a study nests this choice in its folds.
    """
    tried = []
    for way in ways:
        folds = fitted_folds(way, samples, copies)
        found = validated(folds, neighbour_counts, samples, calibrates=calibrates)
        tried.append((way, found, folds))
    return max(
        tried,
        key=lambda of: balanced_accuracy(of[1].codes, of[1].probabilities.argmax(axis=1)),
    )


def cross_validate(
    neighbours: Callable[[], Neighbours],
    neighbour_counts: tuple[int, ...],
    samples: Samples,
    copies: Samples | None = None,
    *,
    calibrates: bool = False,
) -> CrossValidation:
    """Classify every patch out of fold and choose k.

    Parameters
    ----------
    neighbours : callable
        Makes an unfitted `Neighbours`.
    neighbour_counts : tuple of int
        Candidates for k. Those above the samples of a class in a training fold are left out.
    samples : Samples
        At least two groups per class.
    copies : Samples, optional
        Altered copies: trained on where their group is, and never held out.
    calibrates : bool
        Whether a temperature is fitted to the votes.
    """
    folds = fitted_folds(neighbours, samples, copies)
    return validated(folds, neighbour_counts, samples, calibrates=calibrates)


def validated(
    folds: Sequence[Fold], neighbour_counts: tuple[int, ...], samples: Samples, *, calibrates: bool
) -> CrossValidation:
    """What `cross_validate` finds with models that were trained already."""
    features, codes = samples.features, samples.codes
    fewest = min(int(np.bincount(codes[fold.train]).min()) for fold in folds)
    counts = [k for k in sorted(neighbour_counts) if k <= fewest] or [1]
    n_classes = int(codes.max()) + 1
    probabilities = np.full((len(counts), len(codes), n_classes), np.nan)
    distances = np.full(len(codes), np.nan)
    together: list[list[FloatArray]] = [[] for _ in PATCHES]
    for _, test, model in folds:
        labels, distances[test] = model.labels_and_distances(features[test], counts[-1])
        for of, found in zip(together, _of_images(model, samples, test), strict=True):
            of.append(found)
        for i, k in enumerate(counts):
            probabilities[i, test] = vote(labels[:, :k], model.class_weights_)
    kept = np.sort(np.concatenate([fold.test for fold in folds]))
    nested = np.full((len(codes), n_classes), np.nan)
    for _, test, _ in folds:
        others = np.setdiff1d(kept, test)
        rows = others if len(others) else kept
        nested[test] = probabilities[_best(probabilities, codes, rows), test]
    best = _best(probabilities, codes, kept)
    temperature = fitted_temperature(codes[kept], nested[kept]) if calibrates else None
    if calibrates:
        nested = _tempered_by_others(nested, codes, [fold.test for fold in folds])
    return CrossValidation(
        counts[best],
        kept,
        codes[kept],
        nested[kept],
        distances[kept],
        temperature,
        tuple(np.concatenate(of) for of in together),
    )


def _of_images(model: Neighbours, samples: Samples, test: IntArray) -> list[FloatArray]:
    """Distances of images of 1, 2, 4, 8 and 16 patches, parts of held-out photographs."""
    images = [images_of_patches(samples.groups[test], count) for count in PATCHES]
    rows = [part for of in images for part in of]
    _, found = model.labels_and_image_distances(samples.features[test], 1, rows)
    return np.split(found, np.cumsum([len(of) for of in images])[:-1])


def _tempered_by_others(votes: FloatArray, codes: IntArray, tests: list[IntArray]) -> FloatArray:
    """The votes of each fold at the temperature that suits the other folds, if there are others."""
    kept = np.concatenate(tests)
    given = votes.copy()
    for test in tests:
        others = np.setdiff1d(kept, test)
        rows = others if len(others) else kept
        given[test] = tempered(votes[test], fitted_temperature(codes[rows], votes[rows]))
    return given


def _best(probabilities: FloatArray, codes: IntArray, rows: IntArray) -> int:
    scores = [balanced_accuracy(codes[rows], p[rows].argmax(axis=1)) for p in probabilities]
    return int(np.flatnonzero(np.array(scores) == max(scores))[-1])
