"""The answer for one image, and whatever gives such answers."""

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Protocol

from odometry.arrays import AnyArray, ByteImage


@dataclass(frozen=True)
class Classification:
    """The answer for one image.

    Attributes
    ----------
    label : str
        The terrain, or ``unknown`` where `distance` is beyond the rejection threshold.
    confidence : float
        The probability of the likeliest known terrain, also where the label is ``unknown``.
    distance : float
        Distance to the nearest class in the preset's measure; compare with
        `TerrainClassifier.rejection_distance_`.
    probabilities : dict of str to float
        One per known terrain; they add up to 1.
    patches : int
        That the image was cut into.

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
