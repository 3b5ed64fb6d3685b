"""Segmentation-based fractal texture analysis (SFTA), and the steps that it is made of."""

from typing import TYPE_CHECKING

import lazy_loader

from terrain.texture.borders import region_borders
from terrain.texture.box_counting import BITS_OF_BYTE, box_counts, byte_histogram, fractal_dimension
from terrain.texture.otsu import multilevel_otsu, recursive_otsu
from terrain.texture.sfta import feature_names, sfta
from terrain.texture.ttbd import chen2023_members, packed_tables

if TYPE_CHECKING:
    from terrain.texture.transformer import SFTA

# scikit-learn is slow to load
__getattr__, _, _ = lazy_loader.attach(__name__, submod_attrs={"transformer": ["SFTA"]})

__all__ = [
    "BITS_OF_BYTE",
    "SFTA",
    "box_counts",
    "byte_histogram",
    "chen2023_members",
    "feature_names",
    "fractal_dimension",
    "multilevel_otsu",
    "packed_tables",
    "recursive_otsu",
    "region_borders",
    "sfta",
]
