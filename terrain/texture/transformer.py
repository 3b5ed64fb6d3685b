"""SFTA as a scikit-learn transformer."""

from collections.abc import Iterable

import numpy as np

from odometry.arrays import AnyArray, FloatArray
from terrain.texture.image_transformer import ImageTransformer, listed_images, naming_image
from terrain.texture.sfta import feature_names, sfta
from terrain.texture.ttbd import VariantName


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
