"""A classifier on labelled photographs that it was not trained on: confusion and accuracy."""

from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path

import numpy as np

from odometry.arrays import IntArray
from odometry.run import UNKNOWN
from terrain.classification.classifier import Classification, TerrainClassifier
from terrain.classification.evaluation import balanced_accuracy, balanced_accuracy_interval
from terrain.classification.patches import LabelledPhoto
from terrain.classification.trained_on import image_sum
from terrain.errors import ImageError
from terrain.images import read_image


@dataclass(frozen=True)
class LabelledAnswer:
    """The label that a classifier gives to a labelled photograph.

    Attributes
    ----------
    photo : LabelledPhoto
    answer : Classification
    in_training : bool
        Whether the classifier was trained on the same pixels.
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
        seen = trained_on is not None and image_sum(image) in trained_on.image_sums
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
