"""What scikit-learn transformers of images share: they check their input and have no state."""

from abc import abstractmethod
from collections.abc import Iterable, Iterator
from contextlib import contextmanager
from typing import Any, Self

import numpy as np
from sklearn.base import BaseEstimator, TransformerMixin

from odometry.arrays import AnyArray
from terrain.errors import ImageError
from terrain.images import to_bytes


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
