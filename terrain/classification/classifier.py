"""The terrain classifier: SFTA features, a scaler and k nearest neighbours, with rejection."""

import math
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any, Protocol, Self

import numpy as np

from odometry.arrays import AnyArray, ByteImage, IntArray
from odometry.errors import ConfigError
from odometry.run import UNKNOWN
from terrain.classification.features import feature_matrix
from terrain.classification.model_settings import ModelSettings
from terrain.classification.neighbours import vote
from terrain.classification.patches import cut_patches
from terrain.classification.persistence import read_model, write_model
from terrain.classification.presets import PRESETS
from terrain.classification.trained_on import TrainedOn
from terrain.classification.training_set import check_codes, check_labels, common_size, has_colour
from terrain.classification.validation import CrossValidation, cross_validate
from terrain.errors import ImageError, ModelFileError, PatchError


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


class Classifier(Protocol):
    """Whatever names the terrain of images of at least the patch size."""

    classes_: list[str]
    colour_: bool
    patch_size_px: int
    metres_per_pixel: float | None

    def classify(self, images: Sequence[ByteImage]) -> list[Classification]:
        """One answer for each image."""


class TerrainClassifier:
    """Name the terrain of ground patches, or say that it is unknown.

    Parameters
    ----------
    preset : {"default", "chen2023"}
        ``chen2023`` is the paper: SFTA of the grey image (n_t = 4), unscaled, Euclidean nearest
        neighbours. ``default`` takes SFTA of 19 filtered copies of the grey image, counts by
        area, scaled and projected on shrunk linear discriminants before the neighbours vote.
    colour : bool
        Add SFTA of two colour differences (``default`` only). Off by default: colour depends on
        camera, white balance and light, and where each class came from a camera of its own it
        recognises the camera. Use it where training and use share one camera. It stays off if
        the training patches are grey; see `colour_`.
    metres_per_pixel : float, optional
        The scale of the patches on the ground; kept for those who cut patches for it.
    rejected_share : float
        The share of known terrain that may be called unknown: the rejection distance is this
        upper quantile of out-of-fold distances.
    n_neighbors : int, optional
        The number k of neighbours that vote; by default the one of the preset's that is best in
        cross-validation.

    Attributes
    ----------
    classes_ : list of str
    patch_size_px : int
    colour_ : bool
    n_neighbors_ : int
    rejection_distance_ : float
    cross_validation_ : CrossValidation
        Of the last `fit`; a loaded classifier has none.
    trained_on_ : TrainedOn or None
        None where nobody said.

    References
    ----------
    Chen et al. 2023, eq. 18-21 (features) and 23-26 (neighbours).

    Examples
    --------
    >>> import numpy as np
    >>> import terrain
    >>> rng = np.random.default_rng(1)
    >>> mud = [rng.integers(0, 60, (32, 32), dtype=np.uint8) for _ in range(6)]
    >>> snow = [image + 190 for image in mud]
    >>> labels, photographs = ["mud"] * 6 + ["snow"] * 6, [str(i % 6) for i in range(12)]
    >>> classifier = terrain.TerrainClassifier("chen2023").fit(mud + snow, labels, photographs)
    >>> [answer.label for answer in classifier.classify([mud[0], snow[0]])]
    ['mud', 'snow']
    """

    def __init__(
        self,
        preset: str = "default",
        *,
        colour: bool = False,
        metres_per_pixel: float | None = None,
        rejected_share: float = 0.05,
        n_neighbors: int | None = None,
    ) -> None:
        if preset not in PRESETS:
            raise ConfigError(f"preset '{preset}' is not one of {', '.join(sorted(PRESETS))}")
        if not 0 < rejected_share < 1:
            raise ConfigError(f"rejected_share is {rejected_share}, expected between 0 and 1")
        if metres_per_pixel is not None and not 0 < metres_per_pixel < math.inf:
            raise ConfigError(f"metres_per_pixel is {metres_per_pixel}, expected above zero")
        if n_neighbors is not None and n_neighbors < 1:
            raise ConfigError(f"n_neighbors is {n_neighbors}, expected 1 or more")
        self.preset = preset
        self.colour = colour
        self.metres_per_pixel = metres_per_pixel
        self.rejected_share = rejected_share
        self.n_neighbors = n_neighbors

    def fit(
        self,
        images: Sequence[ByteImage],
        labels: Sequence[str],
        groups: Sequence[str],
        progress: bool = False,
        trained_on: TrainedOn | None = None,
    ) -> Self:
        """Learn from labelled patches.

        Parameters
        ----------
        images : sequence of ByteImage
            Square patches of one size, grey (S, S) or RGB (S, S, 3).
        labels, groups : sequences of str
            The terrain of each patch, and the photograph (or part of one) that it is of. k and
            the rejection distance are chosen by cross-validation that keeps groups whole.
        progress : bool
            Show a progress bar.
        trained_on : TrainedOn, optional
            The photographs that the patches are of; kept in the model.

        Raises
        ------
        PatchError
            If the patches differ in size, or there are fewer than two classes, or a class has
            patches of fewer than two groups or fewer than `n_neighbors` in training, or nothing
            varies within the classes.
        """
        check_labels(len(images), labels, groups)
        self.patch_size_px = common_size(images)
        self.classes_ = sorted(set(labels))
        codes: IntArray = np.searchsorted(self.classes_, labels)
        self.trained_on_ = trained_on
        preset = PRESETS[self.preset]
        counts = (self.n_neighbors,) if self.n_neighbors else preset.neighbour_counts
        wanted = self.colour and has_colour(images, labels)
        self._features = preset.colour_features if wanted else preset.features
        self.colour_ = bool(self._features.colour_copies)
        features = feature_matrix(images, self._features, progress)
        try:
            self.cross_validation_: CrossValidation = cross_validate(
                preset.neighbours, counts, features, codes, np.asarray(groups)
            )
            self._neighbours = preset.neighbours().fit(features, codes)
        except np.linalg.LinAlgError as error:
            raise PatchError(
                f"{len(images)} patches of {len(self.classes_)} classes are too few, or too much "
                "alike, to tell how patches of one class differ"
            ) from error
        self.n_neighbors_ = self.cross_validation_.n_neighbors
        if self.n_neighbors_ not in counts and self.n_neighbors:
            raise PatchError(
                f"k = {self.n_neighbors}, but with a part held back a class has fewer patches in "
                "training; choose a smaller k"
            )
        self.rejection_distance_ = float(
            np.quantile(self.cross_validation_.distances, 1 - self.rejected_share)
        )
        return self

    def classify(self, images: Sequence[ByteImage]) -> list[Classification]:
        """Classify images of at least the patch size.

        A larger image is cut into patches side by side; their probabilities are averaged, and
        the median of their distances decides whether it is unknown.

        Raises
        ------
        ImageError
            If an image is smaller than a patch, or grey where the classifier needs colour.
        """
        return [self._classify(image) for image in images]

    def _classify(self, image: ByteImage) -> Classification:
        patches = cut_patches(image, self.patch_size_px)
        if not patches:
            raise ImageError(
                f"image of {image.shape[1]} x {image.shape[0]} pixels is smaller than the "
                f"classifier's patches of {self.patch_size_px} x {self.patch_size_px}"
            )
        if self.colour_ and image.ndim != 3:
            raise ImageError("the image is grey, the classifier was trained with colour")
        features = feature_matrix(patches, self._features)
        labels = self._neighbours.labels(features, self.n_neighbors_)
        probabilities = vote(labels, self._neighbours.class_weights_).mean(axis=0)
        distance = float(np.median(self._neighbours.distances(features)))
        best = int(probabilities.argmax())  # eq. 26
        return Classification(
            self.classes_[best] if distance <= self.rejection_distance_ else UNKNOWN,
            float(probabilities[best]),
            distance,
            dict(zip(self.classes_, probabilities.tolist(), strict=True)),
        )

    def save(self, path: str | Path, made: Mapping[str, Any] | None = None) -> None:
        """Write the classifier to one file of arrays and JSON; see `persistence`.

        `made` says what made it, and is kept in the file.
        """
        settings = ModelSettings(
            self.preset,
            self.colour_,
            self.metres_per_pixel,
            self.rejected_share,
            self.patch_size_px,
            tuple(self.classes_),
            self.n_neighbors_,
            self.rejection_distance_,
            self._features,
            self.trained_on_,
        )
        write_model(Path(path), settings.to_table(), self._neighbours.arrays(), made)

    @classmethod
    def load(cls, path: str | Path) -> Self:
        """Read what `save` wrote. The loaded classifier gives the same answers.

        Raises
        ------
        ModelFileError
            If the file is missing, damaged, foreign, or of a newer program. Nothing in it is
            executed.
        """
        table, arrays = read_model(Path(path))
        try:
            return cls._from_file(ModelSettings.from_table(table), arrays)
        except (KeyError, TypeError, ValueError, ConfigError) as error:
            raise ModelFileError(f"{path}: its settings or arrays do not fit: {error!r}") from error

    @classmethod
    def _from_file(cls, settings: ModelSettings, arrays: dict[str, AnyArray]) -> Self:
        model = cls(
            settings.preset,
            colour=settings.colour,
            metres_per_pixel=settings.metres_per_pixel,
            rejected_share=settings.rejected_share,
        )
        model.colour_ = settings.colour
        model.patch_size_px = settings.patch_size_px
        model.classes_ = list(settings.classes)
        model.n_neighbors_ = settings.n_neighbors
        model.rejection_distance_ = settings.rejection_distance
        model._features = settings.features
        model.trained_on_ = settings.trained_on
        check_codes(arrays["codes"], len(settings.classes))
        model._neighbours = PRESETS[model.preset].neighbours.from_arrays(arrays)
        model._check_that_parts_fit()
        return model

    def _check_that_parts_fit(self) -> None:
        """Ask about one blank patch: ValueError if the parts of a file contradict each other."""
        blank = np.zeros((self.patch_size_px, self.patch_size_px, 3), np.uint8)
        features = feature_matrix([blank], self._features)
        self._neighbours.labels(features, self.n_neighbors_)
        self._neighbours.distances(features)
        if len(self.classes_) != len(self._neighbours.class_weights_):
            raise ValueError(f"{len(self.classes_)} class names for the samples of others")
