"""Array types that the packages share, places of an axis of components, rows and middles."""

from typing import Any

import numpy as np
from numpy.typing import NDArray

FloatArray = NDArray[np.float64]
ComplexArray = NDArray[np.complex128]
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


def spread(count: int, most: int) -> IntArray:
    """At most so many of the numbers below `count`, evenly spread, both ends among them."""
    return np.unique(np.linspace(0, count - 1, min(count, most)).round().astype(np.int64))


def median(values: FloatArray) -> float:
    """`numpy.median` of one or more finite values (K,), in a quarter of its time."""
    half, odd = divmod(len(values), 2)
    if odd:
        return float(np.partition(values, half)[half])
    return float(np.partition(values, (half - 1, half))[half - 1 : half + 1].sum()) / 2


def usual_period_s(stamps_s: FloatArray) -> float:
    """Median time between stamps (N,); 0 of fewer than two."""
    return float(np.median(np.diff(stamps_s))) if len(stamps_s) > 1 else 0.0
