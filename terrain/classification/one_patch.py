"""The paper's decision: one sample, one vote, and always a name (Chen 2023, eq. 24-26)."""

from collections.abc import Sequence
from dataclasses import replace

from odometry.arrays import ByteImage
from terrain.classification.classifier import Classification, TerrainClassifier


class OnePatchClassifier:
    """Labels an image by one patch in its middle; the label is never `unknown`.

    Parameters
    ----------
    classifier : TerrainClassifier
        Fitted. Its average over patches and its rejection are not used.
    """

    def __init__(self, classifier: TerrainClassifier) -> None:
        self._classifier = classifier
        self.classes_ = classifier.classes_
        self.colour_ = classifier.colour_
        self.patch_size_px = classifier.patch_size_px
        self.metres_per_pixel = classifier.metres_per_pixel

    def classify(self, images: Sequence[ByteImage]) -> list[Classification]:
        """Classify images of at least the patch size.

        Raises
        ------
        ImageError
            As `TerrainClassifier.classify`.
        """
        answers = self._classifier.classify([self._middle(image) for image in images])
        return [_named(answer) for answer in answers]

    def middle_used(self, shape: tuple[int, int]) -> tuple[int, int]:
        """Rows and columns in the middle of an image of such a shape: one patch."""
        rows, columns = (min(length, self.patch_size_px) for length in shape)
        return rows, columns

    def _middle(self, image: ByteImage) -> ByteImage:
        size = self.patch_size_px
        top, left = (max(0, (length - size) // 2) for length in image.shape[:2])
        return image[top : top + size, left : left + size]


def _named(answer: Classification) -> Classification:
    probabilities = answer.probabilities
    return replace(answer, label=max(probabilities, key=lambda name: probabilities[name]))
