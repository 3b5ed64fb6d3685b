"""The result of one image: the label of the terrain ahead."""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field

from odometry.recording.run import UNKNOWN
from terrain.classification.answer import (
    COLOURLESS,
    DOUBTFUL,
    GREYISH,
    TURNED,
    UNNOTICED,
    Classification,
)
from terrain.classification.no_ground import DARK, OVEREXPOSED
from terrain.classification.training_light import BY_LIGHT
from terrain.region.region import Region

ASTRIDE = "astride:"  # begins the reason where the two tread strips differ


@dataclass(frozen=True)
class ImageLabel:
    """The label of one image: the terrain ahead.

    Attributes
    ----------
    stamp_s : float
    image : str
        File of the image, as images.csv names it.
    label : str
        A terrain, `unknown`, or "" where there was nothing to classify.
    confidence : float
        Probability of the most probable terrain; NaN without a label.
    region : Region or None
        In the robot frame at this stamp.
    reason : str
        Why there is no label, or what `unknown` means here; else "".
    left, right : str
        Labels of the tread strips, where they were classified apart.
    probabilities : Mapping of str to float
        By the classifier for each terrain, where the region was classified as one.
    class_distance : float
        Distance to the nearest class, which is compared with the rejection threshold; of tread
        strips classified apart the larger one. NaN without a label.
    patches : int
        That the region was cut into, where it was classified as one.
    """

    stamp_s: float
    image: str
    label: str = ""
    confidence: float = float("nan")
    region: Region | None = None
    reason: str = ""
    left: str = ""
    right: str = ""
    probabilities: Mapping[str, float] = field(default_factory=dict)
    class_distance: float = float("nan")
    patches: int = 1

    @property
    def is_evidence(self) -> bool:
        """Whether the label says something of the terrain.

        ``unknown`` says that it resembles none with a name; not where a name is doubtful, the image
        white or black, or where the tread strips differ.
        """
        doubted = (DOUBTFUL, GREYISH, TURNED, UNNOTICED, BY_LIGHT)
        of_nothing = (*doubted, OVEREXPOSED, DARK, COLOURLESS)
        says_nothing = self.is_astride or self.reason.startswith(of_nothing)
        return self.label != UNKNOWN or not says_nothing

    @property
    def is_astride(self) -> bool:
        """Whether the tread strips, classified apart, differ."""
        return self.left != self.right


def answered(
    stamp_s: float, name: str, region: Region, answers: Sequence[Classification]
) -> ImageLabel:
    """The image label of a region by the classifier's answer, or by those for the tread strips."""
    if len(answers) == 1:
        answer = answers[0]
        return ImageLabel(
            stamp_s,
            name,
            answer.label,
            answer.confidence,
            region,
            probabilities=answer.probabilities,
            class_distance=answer.distance,
            patches=answer.patches,
            reason=answer.reason,
        )
    distance = max(answer.distance for answer in answers)
    left, right = (answer.label for answer in answers)
    confidence = min(answer.confidence for answer in answers)
    if left == right:
        why = answers[0].reason or answers[1].reason
        return ImageLabel(
            stamp_s, name, left, confidence, region, why, left, right, class_distance=distance
        )
    reason = f"{ASTRIDE} {left} on the left, {right} on the right"
    return ImageLabel(
        stamp_s, name, UNKNOWN, confidence, region, reason, left, right, class_distance=distance
    )
