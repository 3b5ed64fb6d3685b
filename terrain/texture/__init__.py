"""Segmentation-based fractal texture analysis (SFTA)."""

from terrain.texture.sfta import feature_names, sfta
from terrain.texture.transformer import SFTA

__all__ = ["SFTA", "feature_names", "sfta"]
