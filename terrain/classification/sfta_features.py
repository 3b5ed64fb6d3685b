"""The features of the terrain classifier as a scikit-learn transformer."""

from collections.abc import Iterable

from odometry.arrays import AnyArray, FloatArray
from odometry.errors import ConfigError
from terrain.classification.features.feature_jobs import shared_feature_matrix
from terrain.classification.features.features import FeatureSettings, feature_names
from terrain.classification.presets import PRESETS
from terrain.images import to_bytes
from terrain.texture.transformer import ImageTransformer, listed_images, naming_image


class SftaFeatures(ImageTransformer):
    """What `TerrainClassifier` computes of an image, as a step of a pipeline.

    It has no state: `fit` only checks its input and may be left out. An image is one row,
    whatever its size; counts are by area in the default preset, so that sizes may differ.

    Parameters
    ----------
    preset : {"default", "fast", "chen2023"}
        As in `TerrainClassifier`.
    colour : bool
        Add the features of two colour differences (not with ``chen2023``); images are RGB then.
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
            with naming_image(place):
                images.append(to_bytes(image))
        return shared_feature_matrix(images, settings, processes=self.n_jobs)

    def _names(self) -> list[str]:
        return feature_names(self._settings())

    def _settings(self) -> FeatureSettings:
        if self.preset not in PRESETS:
            raise ConfigError(f"preset '{self.preset}' is not one of {', '.join(sorted(PRESETS))}")
        preset = PRESETS[self.preset]
        return preset.colour_features if self.colour else preset.features
