"""The features of the terrain classifier as a scikit-learn transformer."""

from collections.abc import Iterable
from typing import Any, Self

import numpy as np
from sklearn.base import BaseEstimator, TransformerMixin

from odometry.arrays import AnyArray, FloatArray
from odometry.errors import ConfigError
from terrain.classification.features import FeatureSettings, feature_matrix, feature_names
from terrain.classification.presets import PRESETS
from terrain.images import to_bytes
from terrain.texture.transformer import listed_images, told_where


class SftaFeatures(TransformerMixin, BaseEstimator):  # type: ignore[misc]
    """What `TerrainClassifier` computes of an image, as a step of a pipeline.

    It learns nothing: `fit` only checks its input and may be left out. An image is one row,
    whatever its size; counts are by area in the default preset, so that sizes may differ.

    Parameters
    ----------
    preset : {"default", "chen2023"}
        As in `TerrainClassifier`.
    colour : bool
        Add the features of two colour differences (``default`` only); images are RGB then.
    n_jobs : int
        Processes that share the images; -1 takes all cores. The features are the same.

    Examples
    --------
    >>> import numpy as np
    >>> images = list(np.random.default_rng(1).integers(0, 256, (3, 32, 32), dtype=np.uint8))
    >>> SftaFeatures("chen2023").fit_transform(images).shape
    (3, 24)

    References
    ----------
    Chen et al. 2023, eq. 18-21.
    """

    def __init__(self, preset: str = "default", *, colour: bool = False, n_jobs: int = 1) -> None:
        self.preset = preset
        self.colour = colour
        self.n_jobs = n_jobs

    def fit(self, X: Iterable[AnyArray], y: object = None) -> Self:  # noqa: ARG002
        """Check that there are images to transform; learn nothing.

        Parameters
        ----------
        X : list or array of images
            As in `transform`.
        y : object
            Ignored.

        Raises
        ------
        ImageError, ConfigError
            As in `transform`.
        """
        self._settings()
        for place, image in enumerate(listed_images(X)):
            with told_where(place):
                to_bytes(image)
        return self

    def transform(self, X: Iterable[AnyArray]) -> FloatArray:
        """Give the features of each image.

        Parameters
        ----------
        X : list of images, or array (N, H, W) or (N, H, W, 3)
            Grey or RGB; in a list their sizes may differ.

        Returns
        -------
        (N, n_features) array of float64

        Raises
        ------
        ImageError
            There is no image, or one of them has no features.
        ConfigError
            The preset is not known.
        """
        settings, images = self._settings(), []
        for place, image in enumerate(listed_images(X)):
            with told_where(place):
                images.append(to_bytes(image))
        return feature_matrix(images, settings, processes=self.n_jobs)

    def get_feature_names_out(self, input_features: object = None) -> AnyArray:  # noqa: ARG002
        """Name the features: grey_D1, grey_C1, grey_G1, grey_D2, ...

        Parameters
        ----------
        input_features : object
            Ignored: images have no named features.

        Returns
        -------
        (n_features,) array of str objects
        """
        return np.array(feature_names(self._settings()), dtype=object)

    def _settings(self) -> FeatureSettings:
        if self.preset not in PRESETS:
            raise ConfigError(f"preset '{self.preset}' is not one of {', '.join(sorted(PRESETS))}")
        preset = PRESETS[self.preset]
        return preset.colour_features if self.colour else preset.features

    def __sklearn_tags__(self) -> Any:
        """Tell scikit-learn that the input is images, and that fitting is not needed."""
        tags = super().__sklearn_tags__()
        tags.requires_fit = False
        tags.input_tags.two_d_array = False
        tags.input_tags.three_d_array = True
        return tags
