"""Two-threshold binary decomposition: which greys belong to which binary image."""

import numpy as np

from odometry.arrays import BoolArray, ByteImage, FloatArray

GREYS = np.arange(256.0)


def chen2023_members(thresholds: FloatArray) -> BoolArray:
    """The greys of the 2 n_t binary images of Chen 2023, eq. 19 and 20.

    Parameters
    ----------
    thresholds : (..., n_t) array
        T(1) <= ... <= T(n_t).

    Returns
    -------
    (..., 2 n_t, 256) array of bool
        First T(i) < I for each i, then T(i) < I <= T(i + 1), where the last one has no upper
        bound: image 2 n_t equals image n_t. Eq. 20 prints (0, T(i)) for the first n_t; SFTA
        itself takes the greys above T(i).
    """
    above = thresholds[..., None] < GREYS
    within = above.copy()
    within[..., :-1, :] &= thresholds[..., 1:, None] >= GREYS
    return np.concatenate((above, within), axis=-2)


def costa2012_members(thresholds: FloatArray) -> BoolArray:
    """The greys of the 2 n_t - 1 binary images of SFTA's published code.

    Parameters
    ----------
    thresholds : (..., n_t) array
        As `recursive_otsu` gives them.

    Returns
    -------
    (..., 2 n_t - 1, 256) array of bool
        First T(i) < I for each i, then T(i) < I < T(i + 1) for i < n_t.
    """
    above = thresholds[..., None] < GREYS
    between = above[..., :-1, :] & (thresholds[..., 1:, None] > GREYS)
    return np.concatenate((above, between), axis=-2)


def packed_tables(members: BoolArray) -> ByteImage:
    """Pack the binary images into bytes, eight images to a table of the grey.

    Parameters
    ----------
    members : (..., n, 256) array of bool

    Returns
    -------
    (..., ceil(n / 8), 256) array of uint8
        Bit b of table j at a grey is set where the grey belongs to image 8 j + b.
    """
    return np.packbits(members, axis=-2, bitorder="little")
