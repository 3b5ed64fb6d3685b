"""Windows that start near each other, taken together: their arrays fit the cache."""

from collections.abc import Iterator
from dataclasses import dataclass
from itertools import pairwise

import numpy as np

from odometry.arrays import FloatArray, IntArray
from odometry.geometry.levelled import Tilt
from odometry.windows.windows import Windows

BLOCK = 16384  # samples at a time


@dataclass(frozen=True)
class Block:
    """Some windows, and the samples from the first one's start to the last one's end.

    Attributes
    ----------
    windows, samples : slice
        Which they are.
    ends : (2 K,)
        Where each window starts and ends among these samples, in turn.
    steps_s : (N,)
    tilt : Tilt or None
        Of the samples.
    """

    windows: slice
    samples: slice
    ends: IntArray
    steps_s: FloatArray
    tilt: Tilt | None

    @property
    def first(self) -> IntArray:
        """Samples (K,) at which the windows start."""
        return self.ends[::2]

    @property
    def last(self) -> IntArray:
        """Samples (K,) at which they end."""
        return self.ends[1::2]

    def within(self, steps: FloatArray) -> FloatArray:
        """Sums (..., K) of steps (..., N) from the first to before the last of each window."""
        return np.asarray(np.add.reduceat(steps, self.ends, axis=-1)[..., ::2])


def blocks(windows: Windows) -> Iterator[Block]:
    """The windows in their order."""
    tilt = windows.inputs.tilt
    begins = np.flatnonzero(np.diff(windows.first // BLOCK, prepend=-1))
    for begin, end in pairwise([*begins, len(windows)]):
        chosen = slice(begin, end)
        first, last = windows.first[chosen], windows.last[chosen]
        samples = slice(first.min(), last.max() + 1)
        yield Block(
            chosen,
            samples,
            np.stack([first, last], axis=-1).ravel() - samples.start,
            windows.steps_s[samples],
            None if tilt is None else Tilt(*(part[samples] for part in tilt)),
        )
