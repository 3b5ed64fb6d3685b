"""Features standardised by what a camera itself shows, without labels."""

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from odometry.arrays import ByteImage, FloatArray
from odometry.errors import ConfigError
from terrain.classification.answer import Classification, Classifier
from terrain.classification.classifier import TerrainClassifier
from terrain.classification.config import ClassifierConfig
from terrain.classification.neighbours.metric import ClippedScaler
from terrain.classification.neighbours.neighbours import DiscriminantNeighbours

LEAST = 0.01  # of a deviation in training: a feature that varies less is taken as in training
TWO_CAMERAS = "own statistics are for another camera than that of training, same camera is not"
HALF_AT = 50  # patches: with so many the camera's own statistics have half of their weight


@dataclass(frozen=True, eq=False)
class Moments:
    """Sums of the features of patches and of their squares; `discriminants` likewise.

    Attributes
    ----------
    patches : int
    features, feature_squares : FloatArray, shape (F,)
    discriminants, discriminant_squares : FloatArray, shape (classes - 1,)
    """

    patches: int
    features: FloatArray
    feature_squares: FloatArray
    discriminants: FloatArray
    discriminant_squares: FloatArray

    @classmethod
    def of(cls, features: FloatArray, discriminants: FloatArray) -> "Moments":
        """Of features (n, F) and discriminants (n, classes - 1)."""
        pairs = ((of.sum(axis=0), (of**2).sum(axis=0)) for of in (features, discriminants))
        return cls(len(features), *(array for pair in pairs for array in pair))

    def __add__(self, other: "Moments") -> "Moments":
        names = ("features", "feature_squares", "discriminants", "discriminant_squares")
        sums = (getattr(self, name) + getattr(other, name) for name in names)
        return Moments(self.patches + other.patches, *sums)

    @property
    def spread(self) -> float:
        """Total variance of the discriminants."""
        mean = self.discriminants / self.patches
        return float((self.discriminant_squares / self.patches - mean**2).sum())

    def means_and_deviations(self) -> tuple[FloatArray, FloatArray]:
        """Of each feature (F,)."""
        mean = self.features / self.patches
        variance = self.feature_squares / self.patches - mean**2
        return mean, np.sqrt(np.maximum(variance, 0.0))


def own_weight(neighbours: DiscriminantNeighbours, moments: Moments) -> float:
    """How much a camera's own statistics count, from 0 (those of training) to 1.

    Patches of one terrain vary as patches within a class do, and their mean depends on the terrain
    more than on the camera: the weight is the share of the training variance between classes
    that the images have, and grows with the number of patches.
    """
    points, codes = neighbours.samples()
    of_class = [points[codes == code] for code in np.unique(codes)]
    within = sum(len(of) * float(of.var(axis=0).sum()) for of in of_class) / len(points)
    between = float(points.var(axis=0).sum()) - within
    seen = np.clip((moments.spread - within) / between, 0.0, 1.0) if between > 0 else 0.0
    return float(seen) * moments.patches / (moments.patches + HALF_AT)


def own_scaler(scaler: ClippedScaler, moments: Moments, weight: float) -> ClippedScaler:
    """A scaler whose means are drawn from those of training towards those of `moments`.

    Deviations likewise, in their logarithms.
    """
    mean, deviation = moments.means_and_deviations()
    deviation = np.where(deviation > LEAST * scaler.scale_, deviation, scaler.scale_)
    own = ClippedScaler()
    own.mean_ = weight * mean + (1 - weight) * scaler.mean_
    own.scale_ = deviation**weight * scaler.scale_ ** (1 - weight)
    return own


class OwnStatisticsClassifier:
    """A terrain classifier whose features are standardised by the images classified so far.

    Means and deviations of features are those of training, drawn towards those of the images so
    far with `weight`. It helps with a camera unlike that of training that images several terrains;
    with the camera of training it can harm, where a run has only a few of the terrains.

    Parameters
    ----------
    classifier : TerrainClassifier
        Fitted, of the ``default`` preset.

    Attributes
    ----------
    weight : float
        After the latest image, see `own_weight`.
    patches : int
        Classified so far.

    Raises
    ------
    ConfigError
        If the classifier has no discriminants.
    """

    def __init__(self, classifier: TerrainClassifier) -> None:
        neighbours = classifier.neighbours
        if not isinstance(neighbours, DiscriminantNeighbours):
            raise ConfigError(
                f"own statistics need a model of the default preset, this one is of "
                f"'{classifier.preset}'"
            )
        self._classifier = classifier
        self._neighbours = neighbours
        self._moments: Moments | None = None
        self.weight = 0.0
        self.patches = 0
        self.classes_ = classifier.classes_
        self.colour_ = classifier.colour_
        self.patch_size_px = classifier.patch_size_px
        self.metres_per_pixel = classifier.metres_per_pixel
        self.rejection_distance_ = classifier.rejection_distance_
        self.rejection_distances_ = classifier.rejection_distances_
        self.training_look_ = classifier.training_look_
        self.colour_range_ = classifier.colour_range_
        self.noticed_share_ = classifier.noticed_share_

    def see(self, image: ByteImage) -> FloatArray:
        """Take in an image; the features (patches, F) of its patches.

        Raises
        ------
        ImageError
            As `TerrainClassifier.classify`.
        """
        features = self._classifier.patch_features(image)
        moments = Moments.of(features, self._neighbours.discriminants(features))
        self._moments = moments if self._moments is None else self._moments + moments
        self.patches = self._moments.patches
        self.weight = own_weight(self._neighbours, self._moments)
        return features

    def standardised(self) -> TerrainClassifier:
        """The classifier with the statistics so far; that of training before the first image."""
        if self._moments is None:
            return self._classifier
        scaler = own_scaler(self._neighbours.scaler, self._moments, self.weight)
        return self._classifier.with_neighbours(self._neighbours.rescaled(scaler))

    def classify(self, images: Sequence[ByteImage]) -> list[Classification]:
        """Classify images by the statistics of all so far, these included.

        Raises
        ------
        ImageError
            As `TerrainClassifier.classify`.
        """
        features = [self.see(image) for image in images]
        standardised = self.standardised()
        return [
            standardised.checked(image, standardised.classify_features(of))
            for image, of in zip(images, features, strict=True)
        ]

    def middle_used(self, shape: tuple[int, int]) -> tuple[int, int]:
        """As `TerrainClassifier.middle_used`."""
        return self._classifier.middle_used(shape)

    @property
    def described(self) -> str:
        """What was done."""
        return (
            f"features were standardised by the images' own statistics ({self.patches} patches) "
            f"with a weight of {self.weight:.2f}, and by those of training for the rest"
        )


def used_as(classifier: Classifier, config: ClassifierConfig) -> Classifier:
    """The classifier of a run, as its settings require it.

    Raises
    ------
    ConfigError
        If a setting does not suit the classifier, or another one.
    """
    if config.own_statistics and config.same_camera:
        raise ConfigError(TWO_CAMERAS)
    if config.same_camera and isinstance(classifier, TerrainClassifier):
        return classifier.on_its_camera()
    if not config.own_statistics:
        return classifier
    if not isinstance(classifier, TerrainClassifier):
        raise ConfigError("[classifier] own_statistics needs a model of the default preset")
    return OwnStatisticsClassifier(classifier)
