"""What a trained classifier says of images: the terrain, its probability, and `unknown`."""

from collections.abc import Iterable, Sequence
from copy import copy
from dataclasses import replace
from typing import Self

import numpy as np
from sklearn.utils.validation import check_is_fitted, validate_data

from odometry.arrays import AnyArray, BoolArray, ByteImage, FloatArray
from odometry.recording.run import UNKNOWN
from terrain.classification.answer import COLOURLESS, Classification
from terrain.classification.features.feature_jobs import features_of
from terrain.classification.likeness.colour_range import is_colourless
from terrain.classification.likeness.likeness import FEWEST_IMAGES, Likeness
from terrain.classification.likeness.look import look_of, looks_of, middle_of
from terrain.classification.model_file import ModelFile
from terrain.classification.neighbours.calibration import tempered
from terrain.classification.neighbours.neighbours import DiscriminantNeighbours, Neighbours, vote
from terrain.classification.neighbours.rejection import as_of_one_patch
from terrain.classification.other_things import THINGS
from terrain.classification.photographs.patches import cut_patches
from terrain.classification.photographs.trained_on import as_images, holds_images
from terrain.errors import ImageError


class TrainedClassifier(ModelFile):
    """What a `TerrainClassifier` answers once it is trained."""

    def predict(self, X: Sequence[ByteImage] | AnyArray) -> AnyArray:
        """The likeliest of `classes_` (n,) of each image or row of features, never `unknown`."""
        likeliest = self.predict_proba(X).argmax(axis=1)  # Chen 2023 eq. 26
        return np.asarray(self.classes_[likeliest])

    def predict_proba(self, X: Sequence[ByteImage] | AnyArray) -> FloatArray:
        """Probabilities (n, classes) of images, whose patches are averaged, or of features.

        By the votes alone: those of `classify` fall where images are unlike those of training.
        """
        return self._votes_and_distances(X)[0]

    def is_unknown(self, X: Sequence[ByteImage] | AnyArray) -> BoolArray:
        """Whether each row of features (n,) lies beyond the rejection distance.

        Of images whether `classify` says so: also where they show no terrain.
        """
        if holds_images(X):
            check_is_fitted(self)
            return np.array([answer.label == UNKNOWN for answer in self.classify(X)])
        return self._votes_and_distances(X)[1] > self.rejection_distance_

    def classify(self, images: Sequence[ByteImage]) -> list[Classification]:
        """Classify images of at least the patch size.

        A larger image is cut into patches side by side; their probabilities are averaged, and
        their distance together, on the scale of one patch, decides whether it is unknown: that of
        their mean place among the discriminants, or with ``chen2023`` and models of files before
        version 0.13 the median of their distances. It is unknown as well where it shows no terrain,
        or things, or where the name is improbable, see `Classification.reason`; ``chen2023``,
        models of features and of files before version 0.14 do not check that, and those before
        0.16 not whether it shows things, nor whether the name is improbable. Of a model that uses
        colour it is unknown where its three channels are equal, unless every terrain in training
        has such photographs.

        Raises
        ------
        ImageError
            If an image is smaller than a patch, grey where the classifier needs colour, or no
            image. Images of Pillow are taken as arrays.
        """
        return [
            self.checked(image, self.classify_features(self.patch_features(image)))
            for image in as_images(images)
        ]

    def checked(self, image: ByteImage, answer: Classification) -> Classification:
        """The answer for an image with its confidence, `unknown` if improbable or no terrain."""
        answer = self._calibrated(image, answer)
        if self.shown_ground_ is None:
            return answer
        code = int(np.argmax(list(answer.probabilities.values())))
        reason = self.shown_ground_.lacks(cut_patches(image, self.patch_size_px), code)
        if not reason and self.colour_ and not self._knows_grey and is_colourless(image):
            reason = COLOURLESS
        return replace(answer, label=UNKNOWN, reason=reason) if reason else answer

    @property
    def _knows_grey(self) -> bool:
        return self.colour_range_ is not None and self.colour_range_.knows_grey

    def _calibrated(self, image: ByteImage, answer: Classification) -> Classification:
        look = self.training_look_
        if self.confidence_ is None or look is None:
            return answer
        differences = look.differences(looks_of(image, self.patch_size_px))
        displacement = look.displacement(differences)
        distance = answer.distance / self.rejection_distance_
        votes = np.array([list(answer.probabilities.values())])
        numbers = votes, np.array([distance]), np.array([displacement])
        (given,) = self.confidence_.applied(*numbers)
        calibrated = replace(
            answer,
            confidence=float(given.max()),
            probabilities=dict(zip(answer.probabilities, given.tolist(), strict=True)),
            probability_right=float(self.confidence_.of_being_right(*numbers)[0]),
        )
        return calibrated.unless_improbable()

    def middle_used(self, shape: tuple[int, int]) -> tuple[int, int]:
        """Rows and columns in the middle of an image of such a shape: whole patches, or one."""
        size = self.patch_size_px
        if self.one_patch_:
            return min(shape[0], size), min(shape[1], size)
        return shape[0] - shape[0] % size, shape[1] - shape[1] % size

    def patch_features(self, image: ByteImage) -> FloatArray:
        """Features (patches, F) of the patches that an image is cut into.

        Raises
        ------
        ImageError
            As `classify`.
        """
        if self._features is None:
            raise ImageError("the classifier was fitted on features; expected such, not images")
        patches = cut_patches(image, self.patch_size_px)
        if not patches:
            raise ImageError(
                f"image of {image.shape[1]} x {image.shape[0]} pixels is smaller than the "
                f"classifier's patches of {self.patch_size_px} x {self.patch_size_px}"
            )
        if self.colour_ and image.ndim != 3:
            raise ImageError("the image is grey, the classifier was trained with colour")
        return features_of(patches, self._features)

    def classify_features(self, features: FloatArray) -> Classification:
        """Classify one image by the features (patches, F) of its patches."""
        probabilities, distance = self._of_patches(features)
        best, names = int(probabilities.argmax()), self.classes_.tolist()  # eq. 26
        reason = self._other_than_terrain(features, best)
        return Classification(
            names[best] if distance <= self.rejection_distance_ and not reason else UNKNOWN,
            float(probabilities[best]),
            distance,
            dict(zip(names, probabilities.tolist(), strict=True)),
            len(features),
            reason,
        )

    def _other_than_terrain(self, features: FloatArray, code: int) -> str:
        """Why patches (m, F) of an image named a terrain show things; "" where they may not."""
        neighbours = self._neighbours
        if self.other_things_ is None or not isinstance(neighbours, DiscriminantNeighbours):
            return ""
        scaled = neighbours.scaler.transform(features)
        return THINGS if self.other_things_.include(scaled, code) else ""

    @property
    def neighbours(self) -> Neighbours:
        """What it learned."""
        return self._neighbours

    def on_its_camera(self) -> Self:
        """The same classifier for images that are known to be of the camera of training.

        No name of images that look like training is doubted because another camera's would as well.
        """
        other = copy(self)
        other.noticed_share_ = None
        return other

    def with_neighbours(self, neighbours: Neighbours) -> Self:
        """The same classifier with other neighbours in the same space of features."""
        other = copy(self)
        other._neighbours = neighbours
        return other

    def likeness(self, images: Iterable[ByteImage]) -> Likeness | None:
        """Whether images, as a whole, look like the training photographs; None if unknown.

        Sharpness, scale of texture, contrast and exposure of the middle of each image are compared
        with those of the training patches, of fewer than five images all patches; of models that
        use colour that as well. It says nothing of the terrain.
        """
        if self.training_look_ is None:
            return None
        looks, few, measures = [], [], []
        for image in images:
            middle = middle_of(image, self.patch_size_px)
            looks.append(look_of(middle))
            if len(looks) < FEWEST_IMAGES:
                few.append(looks_of(image, self.patch_size_px))
            if self.colour_range_ is not None and image.ndim == 3:
                measures.append(self.colour_range_.measures([middle]))
        if not 0 < len(looks) < FEWEST_IMAGES:
            likeness = self.training_look_.compared(np.array(looks))
        else:
            likeness = self.training_look_.compared(np.concatenate(few), len(looks))
        if self.colour_range_ is None:
            return likeness
        return self.colour_range_.compared(likeness, np.array(measures))

    def _votes_and_distances(
        self, X: Sequence[ByteImage] | AnyArray
    ) -> tuple[FloatArray, FloatArray]:
        check_is_fitted(self)
        if holds_images(X):
            if not len(X):
                raise ImageError("no images to name, expected one or more")
            answers = (self._of_patches(self.patch_features(image)) for image in as_images(X))
            votes, distances = zip(*answers, strict=True)
            return np.stack(votes), np.array(distances)
        return self._of_features(validate_data(self, X, reset=False))

    def _of_features(self, features: FloatArray) -> tuple[FloatArray, FloatArray]:
        """Probabilities (n, classes) and distances to the nearest class (n,)."""
        labels, distances = self._neighbours.labels_and_distances(features, self.n_neighbors_)
        votes = vote(labels, self._neighbours.class_weights_)
        return tempered(votes, self.temperature_), distances

    def _of_patches(self, features: FloatArray) -> tuple[FloatArray, float]:
        """Mean probabilities (classes,) of the patches of an image, and its distance."""
        limits = self.image_rejection_distances_
        if limits is None:
            votes, distances = self._of_features(features)
            median = float(np.median(distances))
            together = as_of_one_patch(median, len(features), self.rejection_distances_)
            return votes.mean(axis=0), together
        labels, distances = self._neighbours.labels_and_image_distances(
            features, self.n_neighbors_, [np.arange(len(features))]
        )
        votes = tempered(vote(labels, self._neighbours.class_weights_), self.temperature_)
        return votes.mean(axis=0), as_of_one_patch(float(distances[0]), len(features), limits)
