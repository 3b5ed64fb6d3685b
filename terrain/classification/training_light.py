"""Names that would be others in the light of the training photographs."""

from collections.abc import Sequence
from dataclasses import replace

import numpy as np

from odometry.arrays import ByteImage
from odometry.recording.run import UNKNOWN
from terrain.classification.answer import Classification, Classifier
from terrain.classification.likeness.likeness import FEWEST_IMAGES, Likeness

# Of the light of training. Runs of photographs held out, of terrain that is known, lie within.
USUAL_LIGHT = 0.75, 1.33
GREY = 0.01  # of white: a mean is taken as no nearer to black or white
BY_LIGHT = "it would have another name in the light of the training photographs"


def unless_by_light(
    classifier: Classifier,
    images: Sequence[ByteImage],
    answers: Sequence[Classification],
    likeness: Likeness | None,
) -> list[Classification]:
    """The answers, ``unknown`` where the name is another one once the light is that of training.

    In little light every terrain looks like the dark ones that are known, and each image alone is
    like a photograph of these. Light acts as a factor of grey, an exposure or a camera's curve as a
    power of it: the name has to be the same by both. This only removes names. Answers of a
    classifier that is standardised by the run itself stay as they are.

    Parameters
    ----------
    classifier : Classifier
    images : sequence of ByteImage
        One for each answer.
    answers : sequence of Classification
    likeness : Likeness or None
        Of the run that the images are of.
    """
    if likeness is None or not likeness.is_unlike or likeness.images < FEWEST_IMAGES:
        return list(answers)
    from terrain.classification.own_statistics import OwnStatisticsClassifier  # noqa: PLC0415 - slow to load

    is_usual = USUAL_LIGHT[0] < likeness.light < USUAL_LIGHT[1]
    if is_usual or isinstance(classifier, OwnStatisticsClassifier):
        return list(answers)
    return [
        answer
        if answer.label == UNKNOWN
        or all(answer.label == _likeliest(classifier, of) for of in _relit(image, likeness.light))
        else replace(answer, label=UNKNOWN, reason=BY_LIGHT)
        for image, answer in zip(images, answers, strict=True)
    ]


def _relit(image: ByteImage, light: float) -> tuple[ByteImage, ByteImage]:
    """An image in the light of training, its grey times a factor, and to a power."""
    grey = np.arange(256) / 255
    mean = np.clip(image.mean() / 255, GREY, 1 - GREY)
    power = np.log(np.clip(mean / light, GREY, 1 - GREY)) / np.log(mean)
    factor, curve = (
        np.clip(np.rint(255 * of), 0, 255).astype(np.uint8) for of in (grey / light, grey**power)
    )
    return factor[image], curve[image]


def _likeliest(classifier: Classifier, image: ByteImage) -> str:
    (answer,) = classifier.classify([image])
    of = answer.probabilities
    return max(of, key=lambda name: of[name], default=answer.label)
