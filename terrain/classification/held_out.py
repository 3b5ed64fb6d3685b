"""Scores of classifiers, and a classifier on labelled photographs that it was not trained on."""

from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path

import numpy as np
from sklearn.metrics import confusion_matrix, roc_auc_score

from odometry.arrays import AnyArray, BoolArray, FloatArray, IntArray
from odometry.recording.run import UNKNOWN
from terrain.classification.answer import Classification
from terrain.classification.classifier import TerrainClassifier
from terrain.classification.neighbours.validation import balanced_accuracy
from terrain.classification.photographs.patches import LabelledPhoto
from terrain.errors import ImageError
from terrain.images import read_image

BOOTSTRAP_SAMPLES = 2000


def confusion(codes: IntArray, answers: IntArray, n_classes: int) -> IntArray:
    """Count answers (columns) by true class (rows), shape (classes, classes)."""
    return np.asarray(confusion_matrix(codes, answers, labels=range(n_classes)))


def photo_votes(
    codes: IntArray, probabilities: FloatArray, photos: AnyArray
) -> tuple[IntArray, IntArray, AnyArray]:
    """Average the probabilities of the patches of each photograph.

    Parameters
    ----------
    codes : IntArray, shape (n,)
    probabilities : FloatArray, shape (n, classes)
    photos : array, shape (n,)

    Returns
    -------
    codes, answers : IntArray, shape (photographs,)
    rows : array, shape (photographs,)
        The first patch of each photograph, to look up its group.
    """
    _, rows, indices = np.unique(photos, return_index=True, return_inverse=True)
    sums = np.zeros((len(rows), probabilities.shape[1]))
    np.add.at(sums, indices, probabilities)
    return codes[rows], sums.argmax(axis=1), rows


def balanced_accuracy_interval(
    codes: IntArray, answers: IntArray, groups: AnyArray, rng: np.random.Generator
) -> tuple[float, float]:
    """Return the 95 % bootstrap interval of the balanced accuracy.

    Whole groups (photographs) are drawn with replacement within each class, since patches of one
    photograph are no independent evidence. A class of which all are right, or all wrong, has
    nothing to draw: its recall is drawn from what so many groups leave possible (Jeffreys).
    """
    recalls = []
    for c in np.unique(codes):
        chosen = codes == c
        _, members = np.unique(groups[chosen], return_inverse=True)
        sizes = np.bincount(members)
        right = np.bincount(members, weights=(answers == codes)[chosen])
        if right.sum() in {0, sizes.sum()}:
            of_all = rng.beta(len(sizes) + 0.5, 0.5, BOOTSTRAP_SAMPLES)
            recalls.append(of_all if right.any() else 1 - of_all)
            continue
        draws = rng.multinomial(len(sizes), np.full(len(sizes), 1 / len(sizes)), BOOTSTRAP_SAMPLES)
        recalls.append((draws @ right) / (draws @ sizes))
    low, high = np.quantile(np.mean(recalls, axis=0), [0.025, 0.975])
    found = balanced_accuracy(codes, answers)
    return min(float(low), found), max(float(high), found)


def paired_difference(
    codes: IntArray, right: BoolArray, other: BoolArray, groups: AnyArray
) -> tuple[float, float]:
    """How much better one way answers the same patches than another, and its standard error.

    Parameters
    ----------
    codes : IntArray, shape (n,)
    right, other : BoolArray, shape (n,)
        Whether either way answers rightly.
    groups : array, shape (n,)
        Photographs: each is one piece of evidence, however many patches it has.

    Returns
    -------
    difference, standard_error : float
        Of balanced accuracy. The error is infinite where a class has one photograph alone.
    """
    classes = np.unique(codes)
    means, variances = [], []
    for c in classes:
        chosen = codes == c
        _, members = np.unique(groups[chosen], return_inverse=True)
        sizes = np.bincount(members)
        better = np.bincount(members, weights=right[chosen].astype(int) - other[chosen])
        mean = better.sum() / sizes.sum()
        residuals = (better - mean * sizes) / sizes.sum()
        count = len(sizes)
        variance = (residuals**2).sum() * count / (count - 1) if count > 1 else np.inf
        means.append(mean)
        variances.append(variance)
    return float(np.mean(means)), float(np.sqrt(np.sum(variances)) / len(classes))


def rejection_roc_area(known_distances: FloatArray, unknown_distances: FloatArray) -> float:
    """Return the probability that unknown terrain is farther away than known terrain."""
    truth = np.repeat([0, 1], [len(known_distances), len(unknown_distances)])
    return float(roc_auc_score(truth, np.concatenate([known_distances, unknown_distances])))


def confusion_text(table: IntArray, classes: Sequence[str]) -> str:
    """Lay a confusion table out as text: true classes down, answers across, in per cent."""
    width = max(9, *(len(name) + 2 for name in classes))
    lines = [" " * width + "".join(name.rjust(width) for name in classes) + "patches".rjust(width)]
    for name, row in zip(classes, table, strict=True):
        shares = "".join(f"{100 * n / max(row.sum(), 1):{width}.1f}" for n in row)
        lines.append(name.ljust(width) + shares + f"{row.sum():{width}d}")
    return "\n".join(lines)


@dataclass(frozen=True)
class LabelledAnswer:
    """The label that a classifier gives to a labelled photograph.

    Attributes
    ----------
    photo : LabelledPhoto
    answer : Classification
    in_training : bool
        Whether the classifier was trained on it, or on one that looks nearly the same.
    shares_photo_id : bool
        Whether it was trained on a photograph of the same photo_id.
    """

    photo: LabelledPhoto
    answer: Classification
    in_training: bool
    shares_photo_id: bool


@dataclass(frozen=True)
class HeldOutScore:
    """How often each true terrain got each label.

    Attributes
    ----------
    true : tuple of str, length T
        The terrains of the photographs, those that the classifier does not know last.
    labels : tuple of str, length L
        The classifier's terrains, and `unknown`.
    counts : (T, L)
    balanced_accuracy : float or None
        Mean over the known terrains of the share that is named rightly; `unknown` is not right.
        None where there is no photograph of a known terrain.
    interval : (float, float) or None
        Its 95 % bootstrap interval, whole photographs (photo_id) drawn.
    of_named : float or None
        The same of those alone that are not `unknown`; None where a known terrain has none.
    """

    true: tuple[str, ...]
    labels: tuple[str, ...]
    counts: IntArray
    balanced_accuracy: float | None
    interval: tuple[float, float] | None
    of_named: float | None


def answer_photos(
    classifier: TerrainClassifier, photos: Sequence[LabelledPhoto]
) -> tuple[list[LabelledAnswer], dict[Path, str]]:
    """Classify each photograph; those that cannot be used are returned with the reason."""
    answers, unusable = [], {}
    trained_on = classifier.trained_on_
    for photo in photos:
        try:
            image = read_image(photo.path)
            (answer,) = classifier.classify([image])
        except ImageError as error:
            unusable[photo.path] = str(error)
            continue
        seen = trained_on is not None and trained_on.holds(image)
        shares = trained_on is not None and photo.group in trained_on.photo_ids
        answers.append(LabelledAnswer(photo, answer, seen, shares))
    return answers, unusable


def held_out_score(
    classes: Sequence[str], answers: Sequence[LabelledAnswer], seed: int = 0
) -> HeldOutScore:
    """Confusion and accuracy of answers.

    Parameters
    ----------
    classes : sequence of str
        The classifier's terrains.
    answers : sequence of LabelledAnswer
    seed : int
        Of the bootstrap.
    """
    labels = (*classes, UNKNOWN)
    seen = sorted({each.photo.label for each in answers})
    true = (*(n for n in seen if n in classes), *(n for n in seen if n not in classes))
    counts = np.zeros((len(true), len(labels)), dtype=np.int64)
    for each in answers:
        counts[true.index(each.photo.label), labels.index(each.answer.label)] += 1
    known = [each for each in answers if each.photo.label in classes]
    if not known:
        return HeldOutScore(true, labels, counts, None, None, None)
    codes = np.array([labels.index(each.photo.label) for each in known])
    said = np.array([labels.index(each.answer.label) for each in known])
    groups = np.array([each.photo.group for each in known])
    interval = balanced_accuracy_interval(codes, said, groups, np.random.default_rng(seed))
    named = said < len(classes)
    all_named = set(codes[named].tolist()) == set(codes.tolist())
    of_named = balanced_accuracy(codes[named], said[named]) if all_named else None
    return HeldOutScore(true, labels, counts, balanced_accuracy(codes, said), interval, of_named)
