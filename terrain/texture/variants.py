"""What differs between the definitions of SFTA: the paper's text and the published code."""

from collections.abc import Callable
from dataclasses import dataclass
from typing import Any, Literal

import numpy as np

from odometry.arrays import BoolArray, FloatArray
from odometry.errors import ConfigError
from terrain.texture.otsu import multilevel_otsu, recursive_otsu
from terrain.texture.ttbd import chen2023_members, costa2012_members

VariantName = Literal["chen2023", "costa2012"]


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
