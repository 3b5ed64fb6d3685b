"""Transformers of images for scikit-learn: what they share, and SFTA as one."""

from abc import abstractmethod
from collections.abc import Iterable, Iterator
from contextlib import contextmanager
from typing import Any, Self

import numpy as np
from sklearn.base import BaseEstimator, TransformerMixin

from odometry.arrays import AnyArray, FloatArray
from terrain.errors import ImageError
from terrain.images import to_bytes
from terrain.texture.sfta import feature_names, sfta
from terrain.texture.ttbd import VariantName


class ImageTransformer(TransformerMixin, BaseEstimator):  # type: ignore[misc]
    """A step of a pipeline whose rows are images; `fit` may be left out."""

    def fit(self, X: Iterable[AnyArray], y: object = None) -> Self:  # noqa: ARG002
        """Check that there are images to transform.

        Parameters
        ----------
        X : list or array of images
            As in `transform`.
        y : object
            Ignored.

        Returns
        -------
        ImageTransformer
            This object.

        Raises
        ------
        ImageError, ConfigError
            As in `transform`.
        """
        self._names()
        for place, image in enumerate(listed_images(X)):
            with naming_image(place):
                to_bytes(image)
        return self

    def get_feature_names_out(self, input_features: object = None) -> AnyArray:  # noqa: ARG002
        """Name the features.

        Parameters
        ----------
        input_features : object
            Ignored: images have no named features.

        Returns
        -------
        (n_features,) array of str objects
        """
        return np.array(self._names(), dtype=object)

    @abstractmethod
    def _names(self) -> list[str]:
        """Names of the features; a ConfigError where a parameter is wrong."""

    def __sklearn_tags__(self) -> Any:
        """Tell scikit-learn that the input is images, and that fitting is not needed."""
        tags = super().__sklearn_tags__()
        tags.requires_fit = False
        tags.input_tags.two_d_array = False
        tags.input_tags.three_d_array = True
        return tags


def listed_images(X: Iterable[AnyArray]) -> list[AnyArray]:
    """List the images of X; one image alone is not a list of images."""
    if isinstance(X, np.ndarray) and X.ndim not in {3, 4}:
        raise ImageError(f"a list of images or an array (N, H, W[, 3]), not an array {X.shape}")
    images = list(X)
    if not images:
        raise ImageError("there is no image to transform")
    return images


@contextmanager
def naming_image(place: int) -> Iterator[None]:
    """Add the place of the image to errors about it."""
    try:
        yield
    except ImageError as error:
        raise ImageError(f"image {place}: {error}") from error


class SFTA(ImageTransformer):
    """SFTA features of many images, as a step of a pipeline.

    It has no state: `fit` only checks its input and may be left out.

    Parameters
    ----------
    n_thresholds : int
        n_t, as in `terrain.texture.sfta`.
    variant : {"chen2023", "costa2012"}
        As in `terrain.texture.sfta`.

    Examples
    --------
    >>> import numpy as np
    >>> stripes = np.zeros((8, 8), dtype=np.uint8)
    >>> stripes[:, 4:] = 200
    >>> SFTA(n_thresholds=1).fit_transform([stripes, stripes.T]).shape
    (2, 6)
    """

    def __init__(self, n_thresholds: int = 4, variant: VariantName = "chen2023") -> None:
        self.n_thresholds = n_thresholds
        self.variant = variant

    def transform(self, X: Iterable[AnyArray]) -> FloatArray:
        """Give the features of each image.

        Parameters
        ----------
        X : list of images, or array (N, H, W) or (N, H, W, 3)
            Images as in `terrain.texture.sfta`; in a list their sizes may differ.

        Returns
        -------
        (N, n_features) array of float64

        Raises
        ------
        ImageError
            There is no image, or one of them has no features; the message gives its place.
        ConfigError
            A parameter of the transformer is not one of those of `terrain.texture.sfta`.
        """
        rows = []
        for place, image in enumerate(listed_images(X)):
            with naming_image(place):
                rows.append(sfta(image, self.n_thresholds, self.variant))
        return np.stack(rows)

    def _names(self) -> list[str]:
        return feature_names(self.n_thresholds, self.variant)
