"""Features of patches, whatever makes them: SFTA by its settings, or a transformer."""

from collections.abc import Iterable, Sequence
from dataclasses import dataclass
from typing import Protocol

import numpy as np

from odometry.arrays import AnyArray, ByteImage, FloatArray
from terrain.classification.features import FeatureSettings, feature_matrix
from terrain.errors import PatchError
from terrain.images import to_grey


class Transformer(Protocol):
    """Makes features of images, as transformers of scikit-learn do."""

    def transform(self, X: Iterable[AnyArray]) -> AnyArray:
        """Features (n, F) of images, grey (H, W) or RGB (H, W, 3)."""


@dataclass(frozen=True)
class Transformed:
    """Features by a transformer.

    Attributes
    ----------
    transformer : Transformer
        Fitted.
    colour : bool
        Whether it gets colour; else it gets grey patches.
    """

    transformer: Transformer
    colour: bool


def features_of(patches: Sequence[ByteImage], made_by: FeatureSettings | Transformed) -> FloatArray:
    """Features of patches as rows (n, F).

    Raises
    ------
    PatchError
        If a transformer gives no table of finite numbers.
    """
    if isinstance(made_by, FeatureSettings):
        return feature_matrix(patches, made_by)
    shown = patches if made_by.colour else [to_grey(patch) for patch in patches]
    table = np.asarray(made_by.transformer.transform(shown))
    name = type(made_by.transformer).__name__
    if table.ndim != 2 or len(table) != len(patches) or table.dtype.kind not in "fiub":
        raise PatchError(
            f"{name} gives {table.dtype} {table.shape} for {len(patches)} patches; expected a "
            "table of numbers with a row for each"
        )
    features = table.astype(np.float64)
    if not np.isfinite(features).all():
        raise PatchError(f"{name} gives numbers that are not finite")
    return features
