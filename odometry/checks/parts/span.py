"""A span of time: where in a recording something is otherwise, and in words."""

from dataclasses import dataclass

import numpy as np

from odometry.arrays import BoolArray, FloatArray


@dataclass(frozen=True)
class Span:
    """Stamps from the first to before the last; infinite where it begins or ends with the run.

    Where it ends before it begins, it is the time around another span.
    """

    begin_s: float
    end_s: float

    def holds(self, stamps_s: FloatArray) -> BoolArray:
        """Whether each stamp (N,) lies in it."""
        begun, goes_on = stamps_s >= self.begin_s, stamps_s < self.end_s
        return np.asarray(begun | goes_on if self.begin_s > self.end_s else begun & goes_on)

    @property
    def elsewhere(self) -> "Span":
        """The rest of the time."""
        begin_s = -np.inf if np.isinf(self.end_s) else self.end_s
        return Span(begin_s, np.inf if np.isinf(self.begin_s) else self.begin_s)

    def words(self, began_s: float) -> str:
        """When it is, in run time of a run that began at a stamp."""
        begin_s, end_s = self.begin_s - began_s, self.end_s - began_s
        if begin_s > end_s:
            return f"until about {end_s:.0f} s and from about {begin_s:.0f} s on"
        if np.isinf(self.begin_s):
            return f"until about {end_s:.0f} s"
        return f"from about {begin_s:.0f} s {'on' if np.isinf(end_s) else f'to {end_s:.0f} s'}"

    def moments_s(self, began_s: float) -> tuple[tuple[float, float], ...]:
        """Spans without length, in run time, where it begins or ends amid the run."""
        ends_s = (self.begin_s - began_s, self.end_s - began_s)
        return tuple((at_s, at_s) for at_s in ends_s if np.isfinite(at_s))

    def run_time_s(self, began_s: float, lasts_s: float) -> tuple[float, float]:
        """Both ends in run time, within a run that lasts so long."""
        ends_s = np.clip([self.begin_s - began_s, self.end_s - began_s], 0.0, lasts_s)
        return float(ends_s[0]), float(ends_s[1])


def best_rows(gains: FloatArray) -> tuple[int, int]:
    """First row and row after the last of the rows in a row whose gains (K,) add up to most."""
    summed = np.concatenate([[0.0], np.cumsum(gains)])
    after = int(np.argmax(summed - np.minimum.accumulate(summed)))
    return int(np.argmin(summed[: after + 1])), after
