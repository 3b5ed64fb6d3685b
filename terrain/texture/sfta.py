"""Segmentation-based fractal texture analysis: the features of one image."""

import numpy as np

from odometry.arrays import AnyArray, FloatArray
from terrain.images import to_grey
from terrain.texture.stack import stack_features
from terrain.texture.ttbd import VariantName, chosen_variant


def sfta(image: AnyArray, n_thresholds: int = 4, variant: VariantName = "chen2023") -> FloatArray:
    """Give the SFTA features of one image.

    The grey image is cut into binary images by pairs of thresholds; each gives the box-counting
    dimension D of its borders, a number of pixels C and their mean grey G.

    Parameters
    ----------
    image : ndarray, (H, W), (H, W, 3) or (H, W, 4)
        Grey, RGB or RGBA (alpha ignored); uint8, uint16 (divided by 257), bool (0 and 255) or
        float in 0 to 1 (times 255). See `terrain.images.to_grey`.
    n_thresholds : int
        n_t, from 1 to 255.
    variant : {"chen2023", "costa2012"}
        "chen2023" is the paper's text: exact multilevel Otsu, 2 n_t binary images, C and G over
        the region. "costa2012" is the published code of SFTA's authors: recursive Otsu,
        2 n_t - 1 binary images, C and G over the border.

    Returns
    -------
    (6 n_t,) or (6 n_t - 3,) array of float64
        D1, C1, G1, D2, C2, G2, ... in both variants; C in pixels, G in greys of 0 to 255. In
        "chen2023" the last image equals image n_t.

    Raises
    ------
    ImageError
        The image is empty, holds NaN, or is of another shape or kind.
    ConfigError
        n_thresholds or variant is not one of the above.

    Notes
    -----
    Always finite. D is 0 where there is no border and in a 1 x 1 image, and G is 0 where there
    is no pixel; the published code has NaN there. So a flat image gives zeros throughout, and
    an image of k greys has as many non-empty classes in "chen2023" as greys: k - 1 thresholds
    separate them, and the images above the largest grey are empty. Ties between thresholds:
    see `multilevel_otsu`.

    References
    ----------
    Chen et al. 2023, eq. 18 to 21. Costa, Humpire-Mamani and Traina 2012, "An efficient
    algorithm for fractal analysis of textures", and the authors' published program.

    Examples
    --------
    >>> import numpy as np
    >>> stripes = np.zeros((8, 8), dtype=np.uint8)
    >>> stripes[:, 4:] = 200
    >>> sfta(stripes, n_thresholds=1)
    array([  1.,  32., 200.,   1.,  32., 200.])
    """
    definition = chosen_variant(variant, n_thresholds)
    return np.asarray(stack_features(to_grey(image)[None], n_thresholds, definition)[0])


def feature_names(n_thresholds: int = 4, variant: VariantName = "chen2023") -> list[str]:
    """Name the features of `sfta` in their order: D1, C1, G1, D2, ...

    Parameters
    ----------
    n_thresholds, variant
        As in `sfta`.

    Returns
    -------
    list of str

    Raises
    ------
    ConfigError
        As in `sfta`.
    """
    n_images = len(chosen_variant(variant, n_thresholds).members(np.zeros(n_thresholds)))
    return [f"{letter}{image}" for image in range(1, n_images + 1) for letter in "DCG"]
