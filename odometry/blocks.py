"""Long runs block by block, so that what is computed on the way does not grow with them."""

from collections.abc import Callable, Iterator

import numpy as np

from odometry.arrays import FloatArray

TOGETHER = 4096  # rows at a time


def blocks_of(count: int) -> Iterator[slice]:
    """Slices of so many rows in order, TOGETHER each but for the last."""
    return (slice(at, min(at + TOGETHER, count)) for at in range(0, count, TOGETHER))


def running_sums(
    steps: Callable[[slice], FloatArray], count: int
) -> Iterator[tuple[slice, FloatArray]]:
    """Sums of the steps between samples up to each of `count` samples, block by block.

    Parameters
    ----------
    steps : callable
        Gives the steps (k, ...) of a slice; step i leads from sample i to sample i + 1.
    count : int
        Of samples, one more than steps.

    Yields
    ------
    rows : slice
    sums : (n, ...)
        Of these samples, zero at the first of all; to the last bit those of one `np.cumsum`.
    """
    before: FloatArray | None = None
    for rows in blocks_of(count):
        if before is None:
            some = steps(slice(0, rows.stop - 1))
            sums = np.concatenate([np.zeros((1, *some.shape[1:])), np.cumsum(some, axis=0)])
        else:
            some = steps(slice(rows.start - 1, rows.stop - 1))
            some[0] += before
            sums = np.cumsum(some, axis=0)
        before = sums[-1]
        yield rows, sums
