"""Array types that the packages share, and the two places of an axis of components."""

from typing import Any

import numpy as np
from numpy.typing import NDArray

FloatArray = NDArray[np.float64]
IntArray = NDArray[np.int64]
BoolArray = NDArray[np.bool_]
ByteImage = NDArray[np.uint8]
AnyArray = NDArray[Any]


def components_first(vectors: AnyArray) -> AnyArray:
    """Vectors (..., M) as (M, ...): a view; `numpy.moveaxis` takes five times as long."""
    last = vectors.ndim - 1
    return vectors.transpose(last, *range(last))


def components_last(entries: AnyArray) -> AnyArray:
    """Entries (M, ...) as vectors (..., M): a view."""
    return entries.transpose(*range(1, entries.ndim), 0)
