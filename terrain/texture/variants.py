"""What differs between the definitions of SFTA: the paper's text and the published code."""

from collections.abc import Callable
from dataclasses import dataclass
from typing import Any, Literal

import cv2
import numpy as np

from odometry.arrays import AnyArray, BoolArray, ByteImage, FloatArray
from odometry.errors import ConfigError
from terrain.texture.box_counting import BITS_OF_BYTE
from terrain.texture.otsu import multilevel_otsu, recursive_otsu
from terrain.texture.ttbd import chen2023_members, costa2012_members

VariantName = Literal["chen2023", "costa2012"]


@dataclass(frozen=True)
class EightImages:
    """Up to eight binary images of one grey image.

    Attributes
    ----------
    grey : (H, W) array of uint8
    grey_histogram : (256,) array
        Pixels of each grey.
    table : (256,) array of uint8
        Bit b at a grey is set where the grey belongs to image b.
    borders : (H, W) array of uint8
        Bit b is set on the borders of image b.
    """

    grey: ByteImage
    grey_histogram: FloatArray
    table: ByteImage
    borders: ByteImage


def region_pixels(images: EightImages) -> FloatArray:
    """Count the pixels of each grey in each binary image, (256, 8)."""
    return images.grey_histogram[:, None] * BITS_OF_BYTE[images.table]


def border_pixels(images: EightImages) -> FloatArray:
    """Count the pixels of each grey on the borders of each binary image, (256, 8)."""
    joint: AnyArray = cv2.calcHist(
        [images.grey, images.borders], [0, 1], None, [256, 256], [0, 256, 0, 256]
    )
    return joint @ BITS_OF_BYTE


@dataclass(frozen=True)
class Variant:
    """One definition of SFTA.

    Attributes
    ----------
    thresholds : callable
        Grey histogram and n_t to (n_t,) thresholds.
    members : callable
        Thresholds to (n, 256): the greys of each of the n binary images.
    pixels : callable
        `EightImages` to (256, 8): the pixels whose number is C and whose mean grey is G.
    """

    thresholds: Callable[[FloatArray, int], FloatArray]
    members: Callable[[FloatArray], BoolArray]
    pixels: Callable[[EightImages], FloatArray]


VARIANTS = {
    "chen2023": Variant(multilevel_otsu, chen2023_members, region_pixels),
    "costa2012": Variant(recursive_otsu, costa2012_members, border_pixels),
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
