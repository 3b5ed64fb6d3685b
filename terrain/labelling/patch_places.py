"""Places: parts of the terrain that do not overlap, so that no patch is of two of them."""

import numpy as np
from scipy.spatial import cKDTree

from odometry.arrays import FloatArray, IntArray


def place_centres(middles_m: FloatArray, apart_m: float) -> FloatArray:
    """Centres (p, 2) among points (n, 2): each the first that is `apart_m` from those before."""
    centres = np.empty((0, 2))
    for middle_m in middles_m:
        if not np.any(np.hypot(*(centres - middle_m).T) < apart_m):
            centres = np.vstack([centres, middle_m])
    return centres


def places_of(middles_m: FloatArray, centres_m: FloatArray, radius_m: float) -> IntArray:
    """The place in which each square lies whole.

    A place is all that is nearer to its centre than to any other (a Voronoi cell).

    Parameters
    ----------
    middles_m : (n, 2)
        Of the pieces.
    centres_m : (p, 2), p at least 1
    radius_m : float
        From the middle of a piece to its farthest point.

    Returns
    -------
    (n,)
        Index of the place; -1 where the piece crosses a border, or may.
    """
    nearest = cKDTree(centres_m).query(middles_m)[1]
    places = np.array(nearest, dtype=np.int64)
    for place, centre in enumerate(centres_m):
        own = np.flatnonzero(nearest == place)
        others = np.delete(centres_m, place, axis=0)
        between_m = np.hypot(*(others - centre).T)
        to_others = ((middles_m[own, None] - others) ** 2).sum(axis=-1)
        to_own = ((middles_m[own] - centre) ** 2).sum(axis=-1)[:, None]
        crosses = to_others - to_own < 2 * between_m * radius_m  # the border is halfway
        places[own[crosses.any(axis=1)]] = -1
    return places
