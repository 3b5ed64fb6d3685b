"""Two-threshold binary decomposition, and what differs between the definitions of SFTA."""

from collections.abc import Callable
from dataclasses import dataclass
from typing import Any, Literal

import numpy as np

from odometry.arrays import BoolArray, ByteImage, FloatArray
from odometry.errors import ConfigError
from terrain.texture.otsu import multilevel_otsu, recursive_otsu

GREYS = np.arange(256.0)
WEIGHTS_OF_BITS = 1 << np.arange(8, dtype=np.uint8)

VariantName = Literal["chen2023", "costa2012"]


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
    bits = members.view(np.uint8)
    tables = []
    for first in range(0, members.shape[-2], 8):
        eight = bits[..., first : first + 8, :]
        tables.append(np.einsum("...bg,b->...g", eight, WEIGHTS_OF_BITS[: eight.shape[-2]]))
    return np.stack(tables, axis=-2)


@dataclass(frozen=True)
class Variant:
    """One definition of SFTA.

    Attributes
    ----------
    thresholds : callable
        Grey histogram and n_t to (n_t,) thresholds.
    members : callable
        Thresholds to (n, 256): the greys of each of the n binary images.
    of_borders : bool
        Whether C and G are of the pixels of the borders, and not of those of the region.
    """

    thresholds: Callable[[FloatArray, int], FloatArray]
    members: Callable[[FloatArray], BoolArray]
    of_borders: bool


VARIANTS = {
    "chen2023": Variant(multilevel_otsu, chen2023_members, of_borders=False),
    "costa2012": Variant(recursive_otsu, costa2012_members, of_borders=True),
}


def chosen_variant(name: str, n_thresholds: Any) -> Variant:
    """Look a definition up, and check that it can make so many thresholds.

    Raises
    ------
    ConfigError
        There is no such variant, or n_thresholds is not a whole number from 1 to 255.
    """
    if name not in VARIANTS:
        raise ConfigError(f"variant is one of {', '.join(VARIANTS)}, not {name!r}")
    if not isinstance(n_thresholds, int | np.integer) or not 1 <= n_thresholds <= 255:
        raise ConfigError(f"n_thresholds is a whole number from 1 to 255, not {n_thresholds!r}")
    return VARIANTS[name]
