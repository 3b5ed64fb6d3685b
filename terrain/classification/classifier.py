"""The terrain classifier: features, a scaler and k nearest neighbours, with rejection."""

import math
from collections.abc import Sequence
from typing import Any, Self

import numpy as np
from sklearn.base import BaseEstimator, ClassifierMixin
from sklearn.utils.multiclass import check_classification_targets
from sklearn.utils.validation import validate_data

from odometry.arrays import AnyArray, ByteImage
from odometry.errors import ConfigError
from terrain.classification.features.feature_jobs import Transformer, shared_feature_matrix
from terrain.classification.features.features import FeatureSettings
from terrain.classification.learning import LearningClassifier
from terrain.classification.neighbours.validation import Samples
from terrain.classification.old_samples import OldSamples, SamplesBesideOld
from terrain.classification.photographs.other_light import with_other_light
from terrain.classification.photographs.patches import LabelledPatches
from terrain.classification.photographs.trained_on import (
    TrainedOn,
    as_images,
    holds_images,
    labels_and_groups,
)
from terrain.classification.presets import PRESETS


class TerrainClassifier(LearningClassifier, ClassifierMixin, BaseEstimator):  # type: ignore[misc]
    """Name the terrain of patches, or say that it is unknown; a classifier of scikit-learn.

    Parameters
    ----------
    preset : {"default", "fast", "chen2023"}
        ``chen2023`` is the paper: SFTA of the grey image (n_t = 4), unscaled, Euclidean nearest
        neighbours. ``default`` takes SFTA of the grey image at three scales (in colour of all
        filtered copies) and joint and Gabor statistics, scaled and projected on shrunk
        discriminants before the neighbours vote. Whether discriminants may curve (random Fourier
        features) is chosen, and probabilities are calibrated, in cross-validation. ``fast`` does
        so with SFTA of four filtered copies, for small computers. Both learn every second patch
        in another light as well, where they make the features.
    colour : bool
        Add SFTA of two colour differences (not with ``chen2023``). Off by default: colour depends
        on camera, white balance and light, and where each class was photographed by another
        camera, the classifier recognises the camera. Use it where training and use share one
        camera. It stays off if the training patches are grey; see `colour_`.
    metres_per_pixel : float, optional
        The scale of the patches on the terrain; kept for programs that cut patches.
    rejected_share : float
        The share of known terrain that may be called unknown: the rejection distance is this
        upper quantile of out-of-fold distances. In the ``default`` preset the median of several
        patches has a quantile of its own.
    n_neighbors : int, optional
        The number k of neighbours that vote; by default the one of the preset's that is best in
        cross-validation.
    features : transformer, optional
        Makes the features of patches in place of SFTA (``default`` only): any transformer of
        scikit-learn whose input is a list of images, such as `NetworkFeatures`. It sees grey
        patches (S, S), or RGB (S, S, 3) with `colour`. A clone of it is fitted once on all
        patches, without their terrain; one that learns from labels belongs ahead of the
        classifier in a pipeline.

    Attributes
    ----------
    classes_ : array of str
    n_features_in_ : int
        Features of a patch.
    patch_size_px : int
        Where it was fitted on images.
    colour_ : bool
    n_neighbors_ : int
    rejection_distance_ : float
        Of one patch.
    rejection_distances_ : tuple of float
        Of the median of 1, 2, 4, 8, 16 patches.
    image_rejection_distances_ : tuple of float or None
        The same of their mean place, which is judged (`classify` gives it on the scale of one
        patch); None with ``chen2023`` and of files before version 0.13.
    temperature_ : float or None
        Of the votes; None leaves them as they are.
    cross_validation_ : CrossValidation
        Of the last `fit`; a loaded classifier has none.
    trained_on_ : TrainedOn or None
        None where it was not given.
    old_samples_ : OldSamples or None
        What `adapt` mixes with photographs of another camera; None of features, with ``chen2023``
        and of files of version 0.9.
    training_look_ : TrainingLook or None
        What `likeness` compares images with; None of features and of files of version 0.9.
    colour_range_ : ColourRange or None
        The same for colours; None where `colour_` is not, and of files before version 0.36.
    noticed_share_ : float or None
        Of altered training photographs that `likeness` calls unlike; None without such looks, where
        no terrain has five photographs, and of files before version 0.34.
    shown_ground_, other_things_ : ShownGround, OtherThings or None
        Limits by terrain; None of features, with ``chen2023`` and of files before 0.14, 0.16.
    confidence_ : AnswerConfidence or None
        None where `other_things_` is, and where all held-out answers are right or all are wrong.

    Notes
    -----
    X is images, or a table (n, F) of features that were made before, as by `SftaFeatures`. As
    scikit-learn requires, `predict` names one of `classes_`, the likeliest; what may be trusted
    is said by `is_unknown`, and by `classify`, which says both.

    References
    ----------
    Chen et al. 2023, eq. 18-21 (features), eq. 23-26 (neighbours).

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
        features: Transformer | None = None,
    ) -> None:
        self.preset = preset
        self.colour = colour
        self.metres_per_pixel = metres_per_pixel
        self.rejected_share = rejected_share
        self.n_neighbors = n_neighbors
        self.features = features

    def fit(
        self,
        X: Sequence[ByteImage] | AnyArray,
        y: Sequence[str] | AnyArray,
        groups: Sequence[str] | AnyArray | None = None,
        *,
        copies: LabelledPatches | None = None,
        beside: OldSamples | None = None,
        progress: bool = False,
        trained_on: TrainedOn | None = None,
        processes: int = 1,
        scheduler: str | None = None,
    ) -> Self:
        """Train on labelled patches.

        Parameters
        ----------
        X : sequence of images, or (n, F) array
            Square patches of one size, grey (S, S) or RGB (S, S, 3); or features, which have no
            copies in another light beside them.
        y : sequence of str
            The terrain of each patch.
        groups : sequence of str, optional
            The photograph (or part of one) of each patch; by default each patch has its own.
            k and the rejection distance are chosen by cross-validation that keeps groups whole.
        copies : LabelledPatches, optional
            Altered patches of the same photographs, see `augmentation`, where X is images: they
            are trained on, and never held out. With ``chen2023`` there are none.
        beside : OldSamples, optional
            Samples of a model for another camera: moved to the features of this one they are
            trained on, and never held out. Of terrains in `y` alone.
        progress : bool
            Show a progress bar.
        trained_on : TrainedOn, optional
            The photographs that the patches are of; kept in the model.
        processes : int
            That share the images; -1 takes all cores. What is learned is the same.
        scheduler : str, optional
            Address of a Dask scheduler, whose workers share the images instead.

        Raises
        ------
        ConfigError
            If a parameter is out of its range.
        PatchError
            If the patches differ in size, or there are fewer than two classes, or a class has
            patches of fewer than two groups or fewer than `n_neighbors` in training, or nothing
            varies within the classes.
        BatchError
            If the cluster cannot do it.
        """
        self._check_parameters()
        if copies is not None and (PRESETS[self.preset].as_published or not holds_images(X)):
            raise ConfigError(f"altered copies are for images and not for '{self.preset}'")
        altered = copies or LabelledPatches()
        strange: list[ByteImage] = []
        if holds_images(X):
            X = as_images(X)
            labels, photos = labels_and_groups(len(X), y, groups)
            strange = self._strange_patches(X, photos)
            made_by = self._made_by([*X, *altered.images], labels)
            if isinstance(made_by, FeatureSettings) and not PRESETS[self.preset].as_published:
                altered = with_other_light(altered, X, (labels, photos), colour=self.colour_)
            features = shared_feature_matrix(
                [*X, *altered.images, *strange],
                made_by,
                processes=processes,
                scheduler=scheduler,
                show_progress=progress,
            )
            self.n_features_in_ = features.shape[1]
        else:
            self._features, self.colour_ = None, False
            features, labels = validate_data(self, X, y, ensure_min_samples=2)
            check_classification_targets(labels)
            labels, photos = labels_and_groups(len(features), labels, groups)
        self.classes_, codes = np.unique(labels, return_inverse=True)
        self.trained_on_ = trained_on
        samples = Samples(features[: len(labels)], codes, photos)
        self._look_at(X if holds_images(X) else None, samples, labels)
        if beside is not None:
            known = beside.of_terrains(self.classes_)
            old_codes = np.searchsorted(self.classes_, known.labels)
            samples = SamplesBesideOld(samples.features, codes, photos, known.features, old_codes)
        others = Samples(
            features[len(labels) : len(features) - len(strange)],
            np.searchsorted(self.classes_, altered.labels),
            np.asarray(altered.groups) if altered.groups else photos[:0],
        )
        self._learn(samples, others, strange, features[len(features) - len(strange) :])
        return self

    def _check_parameters(self) -> None:
        if self.preset not in PRESETS:
            raise ConfigError(f"preset '{self.preset}' is not one of {', '.join(sorted(PRESETS))}")
        if self.features is not None and self.preset != "default":
            raise ConfigError(f"the preset '{self.preset}' makes its own features; leave one out")
        if not 0 < self.rejected_share < 1:
            raise ConfigError(f"rejected_share is {self.rejected_share}, expected between 0 and 1")
        scale = self.metres_per_pixel
        if scale is not None and not 0 < scale < math.inf:
            raise ConfigError(f"metres_per_pixel is {scale}, expected above zero")
        if self.n_neighbors is not None and self.n_neighbors < 1:
            raise ConfigError(f"n_neighbors is {self.n_neighbors}, expected 1 or more")

    def __sklearn_tags__(self) -> Any:
        """Tell scikit-learn that the input is images or features."""
        tags = super().__sklearn_tags__()
        tags.input_tags.three_d_array = True
        return tags
