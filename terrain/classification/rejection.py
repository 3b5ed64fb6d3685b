"""The distance above which an image is unknown, by its number of patches."""

from collections.abc import Sequence

import numpy as np

from odometry.arrays import AnyArray, FloatArray

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
    members = [np.flatnonzero(groups == group) for group in np.unique(groups)]
    limits = []
    for count in PATCHES:
        medians = [
            float(np.median(distances[rows[start :: max(len(rows) // count, 1)]]))
            for rows in members
            for start in range(max(len(rows) // count, 1))
        ]
        limits.append(float(np.quantile(medians, 1 - rejected_share)))
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
