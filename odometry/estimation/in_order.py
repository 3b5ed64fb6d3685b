"""Frames that come late, put in their place: the answer is that of frames in order."""

from bisect import bisect_right
from typing import NamedTuple, Protocol

from odometry.errors import EstimationError
from odometry.estimation.estimate import Estimate
from odometry.recording.frames import Frame


class Stepping(Protocol):
    """A filter that steps from frame to frame."""

    def step(self, estimate: Estimate, frame: Frame, terrain: str) -> Estimate:
        """The next estimate."""


class _Step(NamedTuple):
    frame: Frame
    terrain: str
    estimate: Estimate


class InOrder:
    """A filter that remembers its latest steps, and takes them again after a late frame.

    Parameters
    ----------
    stepping : Stepping
    started : Estimate
        Where it starts; no frame may be older.
    keep_s : float
        For how long steps are remembered: how late a frame may be.

    Notes
    -----
    Each frame holds the speeds in force from its own stamp on and the mean yaw rate since the
    frame before it, as `Run.frames` has them; so the answer after a late frame is exactly that of
    the same frames in order. Frames of one stamp keep the order in which they came.
    """

    def __init__(self, stepping: Stepping, started: Estimate, keep_s: float = 2.0) -> None:
        self._filter = stepping
        self._keep_s = keep_s
        self._before = started
        self._steps: list[_Step] = []

    @property
    def estimate(self) -> Estimate:
        """The latest."""
        return self._steps[-1].estimate if self._steps else self._before

    def step(self, frame: Frame, terrain: str) -> Estimate:
        """The estimate at the latest stamp, after one more frame.

        Raises
        ------
        EstimationError
            If the frame is older than all that is remembered; nothing is changed then.
        """
        if frame.stamp_s < self._before.stamp_s:
            raise EstimationError(
                f"a frame of {frame.stamp_s} s came when the filter was at "
                f"{self.estimate.stamp_s} s and remembered steps since "
                f"{self._before.stamp_s} s: it is too late; expected at most {self._keep_s} s"
            )
        place = bisect_right([step.frame.stamp_s for step in self._steps], frame.stamp_s)
        later = self._steps[place:]
        del self._steps[place:]
        self._append(frame, terrain)
        for step in later:
            self._append(step.frame, step.terrain)
        self._forget()
        return self.estimate

    def _append(self, frame: Frame, terrain: str) -> None:
        self._steps.append(_Step(frame, terrain, self._filter.step(self.estimate, frame, terrain)))

    def _forget(self) -> None:
        oldest_s = self.estimate.stamp_s - self._keep_s
        while len(self._steps) > 1 and self._steps[0].frame.stamp_s < oldest_s:
            self._before = self._steps.pop(0).estimate
