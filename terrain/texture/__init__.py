"""Segmentation-based fractal texture analysis (SFTA), and the steps that it is made of."""

from terrain.texture.borders import region_borders
from terrain.texture.box_counting import BITS_OF_BYTE, box_counts, byte_histogram, fractal_dimension
from terrain.texture.otsu import multilevel_otsu, recursive_otsu
from terrain.texture.sfta import feature_names, sfta
from terrain.texture.transformer import SFTA
from terrain.texture.ttbd import chen2023_members, packed_tables

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
