"""Values between the samples of a run, at many times at once."""

from dataclasses import dataclass

import numpy as np

from odometry.arrays import FloatArray, IntArray


@dataclass(frozen=True)
class Between:
    """Where times lie between samples (N,).

    Attributes
    ----------
    before : (...)
        Number of the last sample before each time, that has one after it.
    share : (...)
        Of the way from there to the next sample, 0 to 1.
    """

    before: IntArray
    share: FloatArray

    def of(self, values: FloatArray) -> FloatArray:
        """Values (C..., ...) there of those (C..., N) of the samples."""
        first = values.take(self.before, axis=-1)
        after = values.take(self.before + 1, axis=-1)
        after -= first
        after *= self.share
        first += after
        return first

    def rows(self, chosen: IntArray) -> "Between":
        """Some of the times (M,), in the shape in which they are chosen."""
        return Between(self.before[chosen], self.share[chosen])


def between(time_s: FloatArray, asked_s: FloatArray) -> Between:
    """Where times (M,) lie between samples stamped (N,), two or more; those beyond at the ends."""
    places = np.interp(asked_s, time_s, np.arange(len(time_s), dtype=np.float64))
    before = np.minimum(places.astype(np.int64), len(time_s) - 2)
    return Between(before, places - before)
