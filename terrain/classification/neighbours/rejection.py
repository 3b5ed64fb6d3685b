"""The distance above which an image is unknown, by its number of patches."""

from collections.abc import Sequence

import numpy as np

from odometry.arrays import AnyArray, FloatArray, IntArray

PATCHES = (1, 2, 4, 8, 16)


def rejection_distances(
    distances: FloatArray, groups: AnyArray, rejected_share: float
) -> tuple[float, ...]:
    """Distances beyond which the median of 1, 2, 4, 8 and 16 patches of known terrain seldom lies.

    The median of many patches of one photograph varies less than the distance of one patch, so
    that it is unknown from a smaller distance on.

    Parameters
    ----------
    distances : FloatArray, shape (n,)
        Of patches that were held out.
    groups : array, shape (n,)
        The photograph of each patch; one with fewer patches than required gives all of them.
    rejected_share : float
        The share of known terrain that lies beyond.

    Returns
    -------
    tuple of float, length 5
        From one to 16 patches, none larger than the one before.
    """
    images = [images_of_patches(groups, count) for count in PATCHES]
    medians = [np.array([np.median(distances[rows]) for rows in of]) for of in images]
    return quantiles(medians, rejected_share)


def images_of_patches(groups: AnyArray, count: int) -> list[IntArray]:
    """Rows of patches that stand for images of so many patches: parts of photographs.

    The patches of a part are spread over the photograph (n,); one with fewer patches than
    required is one part.
    """
    images = []
    for group in np.unique(groups):
        rows = np.flatnonzero(groups == group)
        step = max(len(rows) // count, 1)
        images += [rows[start::step] for start in range(step)]
    return images


def quantiles(distances: Sequence[FloatArray], rejected_share: float) -> tuple[float, ...]:
    """What a share of held-out images lies beyond, from one to 16 patches.

    Parameters
    ----------
    distances : sequence of FloatArray, length 5
        Of images of 1, 2, 4, 8 and 16 patches.
    rejected_share : float

    Returns
    -------
    tuple of float, length 5
        None larger than the one before.
    """
    limits = [float(np.quantile(of, 1 - rejected_share)) for of in distances]
    return tuple(np.minimum.accumulate(limits).tolist())


def rejection_limit(patches: int, limits: Sequence[float]) -> float:
    """The distance beyond which the median of so many patches is unknown."""
    return float(np.interp(np.log(patches), np.log(PATCHES[: len(limits)]), limits))


def as_of_one_patch(distance: float, patches: int, limits: Sequence[float]) -> float:
    """The median distance of some patches, on the scale of the distance of one patch.

    It is beyond the limit of one patch where the median is beyond that of so many patches.
    """
    limit = rejection_limit(patches, limits)
    return distance * limits[0] / limit if limit > 0 else distance
