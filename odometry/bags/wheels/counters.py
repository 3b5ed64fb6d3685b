"""Counts of encoders, which wrap where their counter overflows."""

import numpy as np

from odometry.arrays import FloatArray

BITS = (16, 32)
SURE = 0.75  # of the size of a counter: a smaller step may be a reset, or a true one
FAR = 0.4  # of it: a step beyond fits the other way round nearly as well


class Counters:
    """Takes differences of places, and adds the size of a counter where it wrapped.

    Only whole numbers that all lie within a counter's range wrap: angles and metres do not.

    Attributes
    ----------
    wraps : int
        Messages in which a counter wrapped.
    far, moved : int
        Steps, once unwrapped, of nearly half its size or more; all steps but those of zero.
    """

    def __init__(self) -> None:
        self.wraps = self.far = self.moved = 0
        self._bits = 0
        self._whole, self._low, self._high = True, np.inf, -np.inf

    def steps(self, places: FloatArray) -> FloatArray:
        """Differences (N - 1, k) of places (N, k), calls in the order of time."""
        steps = np.diff(places, axis=0)
        known = places[np.isfinite(places)]
        self._whole = self._whole and bool(np.all(known == np.rint(known)))
        self._low = min(self._low, known.min(initial=np.inf))
        self._high = max(self._high, known.max(initial=-np.inf))
        self._bits = next((bits for bits in BITS if self._fits(2.0**bits)), 0)
        if not (self._whole and self._bits):
            return steps
        size = 2.0**self._bits
        wrapped = np.abs(steps) > SURE * size
        self.wraps += int(np.count_nonzero(wrapped.any(axis=1)))
        steps = np.where(wrapped, steps - size * np.sign(steps), steps)
        self.far += int(np.count_nonzero(np.abs(steps) > FAR * size))
        self.moved += int(np.count_nonzero(steps))
        return steps

    def notes(self, topic: str) -> list[str]:
        """What is to be said of them."""
        if not self.wraps:
            return []
        return [
            f"{topic}: a counter of {self._bits} bits wrapped in {self.wraps} messages: "
            f"{2**self._bits} was added to such differences, or taken off"
        ]

    def _fits(self, size: float) -> bool:
        signed = -size / 2 <= self._low and self._high < size / 2
        return signed or (self._low >= 0 and self._high < size)
