"""The answer of a classifier for one image, and what gives it."""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace
from typing import Protocol, Self

from odometry.arrays import AnyArray, ByteImage
from odometry.recording.run import UNKNOWN
from terrain.classification.likeness.likeness import FEWEST_IMAGES, Likeness
from terrain.classification.likeness.noticed_alterations import may_pass_unnoticed

# Probability of being right: a wrong name costs more than twice what a right one brings.
TRUSTED = 0.7
DOUBTFUL = f"unlike the training photographs, and not right with a probability of {TRUSTED} or more"
UNNOTICED = (
    "another camera would not be noticed, and the name is not right with a probability of "
    f"{TRUSTED} or more"
)
# Where images are so far beyond training (`Likeness.beyond`), no name is worth much: of a model
# whose answers were all right where they were held out, which teaches it no such probability; and
# of one that learned it, whose altered photographs lie nearer.
MOST_BEYOND, MOST_BEYOND_LEARNED = 2.0, 10.0
TOO_UNLIKE = "too far from the training photographs for any name"
# Nearly grey runs so far beyond their limit had a wrong terrain in force as often as the right one
# (652 and 789 frames), a nearer one seldom (103 and 623): made ones over ground/, development
MOST_GREY = 1.15
COLOURLESS = "the image is grey (its three channels are equal), the model was trained with colour"
ONE_CHANNEL = "the image is grey, the model was trained with colour"
GREYISH = "nearly grey, unlike the training photographs of a model in colour"
TURNED = "red, green and blue seem to be in another order than in the training photographs"
# Of any image: three of four such names would be wrong.
PROBABLE = 0.25
IMPROBABLE = f"right with a probability below {PROBABLE}"


@dataclass(frozen=True)
class Classification:
    """The answer for one image.

    Attributes
    ----------
    label : str
        The terrain, or ``unknown`` where `distance` is beyond the rejection threshold.
    confidence : float
        The probability of the likeliest known terrain, also where the label is ``unknown``. It
        falls where the image is unlike the training photographs.
    distance : float
        Distance to the nearest class in the preset's measure; compare with
        `TerrainClassifier.rejection_distance_`.
    probabilities : dict of str to float
        One per known terrain; they add up to 1.
    patches : int
        That the image was cut into.
    reason : str
        Why the label is ``unknown``: the image shows no terrain, or the name is doubtful or
        improbable; else "".
    probability_right : float or None
        That the likeliest terrain is the right one, learned from images held out; `confidence` is
        no less than chance. None of models that did not learn it.

    Examples
    --------
    >>> import terrain
    >>> answer = terrain.Classification("unknown", 0.9, 3.2, {"grass": 0.9, "gravel": 0.1})
    >>> max(answer.probabilities, key=answer.probabilities.get)  # what it would have been
    'grass'
    """

    label: str
    confidence: float
    distance: float
    probabilities: dict[str, float]
    patches: int = 1
    reason: str = ""
    probability_right: float | None = None

    def unless_doubtful(
        self, likeness: Likeness | None, noticed_share: float | None = None
    ) -> Self:
        """The answer, ``unknown`` where its name is not right with `TRUSTED` or more.

        No name is left where the images together, of which this is one, are far beyond training,
        or before a model in colour nearly grey, or with channels in another order where images of
        another camera would be like training as well; else these names need `TRUSTED`.
        Nothing is asked where they are like the training photographs, as many right names would be
        lost as wrong ones; but where images of another camera would be like them as well, it is.

        Parameters
        ----------
        likeness : Likeness or None
            Of these images.
        noticed_share : float, optional
            Of the model, see `TerrainClassifier`; None where the camera is that of training.
        """
        if likeness is None or not likeness.images or self.label == UNKNOWN:
            return self
        is_grey, is_turned = likeness.grey_beyond > MOST_GREY, likeness.turned_beyond > 1
        if is_grey or (is_turned and may_pass_unnoticed(noticed_share)):
            reason = TURNED if is_turned else GREYISH  # grey is like any order
            return replace(self, label=UNKNOWN, reason=reason)
        if is_turned:
            return self._if_trusted(TURNED)
        if not likeness.is_unlike:
            return self._if_trusted(UNNOTICED) if may_pass_unnoticed(noticed_share) else self
        learned = self.probability_right is not None
        most = MOST_BEYOND_LEARNED if learned else MOST_BEYOND
        are_many = likeness.images >= FEWEST_IMAGES  # of fewer, one black image decides
        if are_many and likeness.beyond is not None and likeness.beyond > most:
            return replace(self, label=UNKNOWN, reason=TOO_UNLIKE)
        return self._if_trusted(DOUBTFUL)

    def _if_trusted(self, reason: str) -> Self:
        if self.probability_right is None or self.probability_right >= TRUSTED:
            return self
        return replace(self, label=UNKNOWN, reason=reason)

    def unless_improbable(self) -> Self:
        """The answer, ``unknown`` where its name is right with less than `PROBABLE`.

        Asked of every image: those of the own camera seldom have such a name.
        """
        if self.label == UNKNOWN or self.probability_right is None:
            return self
        if self.probability_right >= PROBABLE:
            return self
        return replace(self, label=UNKNOWN, reason=IMPROBABLE)


class Classifier(Protocol):
    """Whatever names the terrain of images of at least the patch size."""

    classes_: AnyArray
    colour_: bool
    patch_size_px: int
    metres_per_pixel: float | None

    def classify(self, images: Sequence[ByteImage]) -> list[Classification]:
        """One answer for each image."""

    def middle_used(self, shape: tuple[int, int]) -> tuple[int, int]:
        """Rows and columns in the middle of an image of such a shape: all that is looked at."""


def colourless_note(reasons: Mapping[str, int], images: int) -> str | None:
    """How many images are grey before a model in colour, by how many have each reason; or None."""
    grey = reasons.get(COLOURLESS, 0) + reasons.get(ONE_CHANNEL, 0)
    if not grey:
        return None
    return (
        f"{grey} of {images} images have no name, since they are grey (one channel, or three equal "
        "ones) and the model was trained with colour"
    )
