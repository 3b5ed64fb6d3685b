"""Gaps of odometry.csv, afterwards and as it drives: held speeds that were not the true ones.

data/README.md: a tread speed holds until the next stamp, however long; it is a gap only where other
files contradict the held speed, or where it lasts long, the treads turn, and nothing confirms it.
"""

from collections import deque
from dataclasses import dataclass, replace
from statistics import median

import numpy as np

from odometry.arrays import AnyArray, FloatArray
from odometry.recording.frames import Frame
from odometry.recording.run import Run
from odometry.windows.recorded.held_speeds import gyroscope_evidence, pose_evidence

HOLD_PERIODS = 5.0  # usual periods up to which a step is a hold
LONG_S, LONG_PERIODS = 1.0, 20.0  # beyond both a held speed needs another sensor that confirms it
STANDING_M_S = 0.01  # of a tread, or less
REPEATS = 0.05  # share of the rows: a log that repeats its row so often is not one of changes
BY_GYROSCOPE = "the gyroscope contradicts the held speed"
BY_POSES = "the poses contradict the held speed"
SILENT = "nothing else confirms that the held speed lasted"


@dataclass(frozen=True)
class Gaps:
    """G gaps of odometry.csv in order.

    Attributes
    ----------
    spans_s : (G, 2)
        The stamps between which each lies.
    reasons : (G,) of str
    """

    spans_s: FloatArray
    reasons: AnyArray

    def __len__(self) -> int:
        return len(self.spans_s)


def odometry_gaps(run: Run) -> Gaps:
    """Find the gaps of odometry.csv.

    A step of more than five usual periods is a gap

    - where the gyroscope or the poses contradict the held speeds, see `held_speeds`;
    - where it is longer than 1 s and than 20 usual periods, a tread turns, and nothing says that
      it went on so. Poses do, all along it; a gyroscope, which measures turns alone, only where
      odometry.csv is a log of changes: one that repeats its row now and then would have done so.
    """
    stamps_s, speeds = run.odometry.stamps_s, run.odometry.stack("v_left", "v_right")
    periods_s = np.diff(stamps_s)
    usual_s = float(np.median(periods_s)) if len(periods_s) else 0.0
    holds = np.flatnonzero(periods_s > HOLD_PERIODS * usual_s)
    if not len(holds):
        return Gaps(np.empty((0, 2)), np.empty(0, dtype=object))
    spans_s = np.column_stack([stamps_s[holds], stamps_s[holds + 1]])
    by_gyroscope, by_poses = gyroscope_evidence(run, spans_s), pose_evidence(run, spans_s)
    repeated = np.all(speeds[1:] == speeds[:-1], axis=1) & (periods_s <= HOLD_PERIODS * usual_s)
    moving = np.abs(speeds).max(axis=1) > STANDING_M_S
    of_changes = np.count_nonzero(repeated & moving[1:]) <= REPEATS * np.count_nonzero(moving)
    long = periods_s[holds] > max(LONG_S, LONG_PERIODS * usual_s)
    supported = by_poses.agrees | (by_gyroscope.agrees & of_changes)
    reasons = np.select(
        [by_gyroscope.contradicts, by_poses.contradicts, long & moving[holds] & ~supported],
        [BY_GYROSCOPE, BY_POSES, SILENT],
        "",
    ).astype(object)
    found = reasons != ""
    return Gaps(spans_s[found], reasons[found])


PERIODS = 100  # latest periods of odometry whose median is the usual one


class GapsSoFar:
    """Decides of each frame whether the speeds that led to it were held for too long to be known.

    Too long is more than 1 s and than 20 usual periods with a tread turning, as in
    `odometry_gaps`; what other sensors say of the held speeds is not used, because they say it
    later.
    """

    def __init__(self) -> None:
        self._periods_s: deque[float] = deque(maxlen=PERIODS)
        self._row = -1
        self._stamp_s = 0.0
        self._turning = False

    def marked(self, frame: Frame) -> Frame:
        """The frame with its `in_gap`; frames come in order of time."""
        held_s = frame.stamp_s - self._stamp_s
        in_gap = self._turning and held_s > LONG_S and held_s > LONG_PERIODS * self._usual_s()
        if frame.odometry_row != self._row:
            if self._row >= 0:
                self._periods_s.append(held_s)
            self._row, self._stamp_s = frame.odometry_row, frame.stamp_s
            self._turning = bool(np.max(np.abs(frame.tread_speeds_m_s)) > STANDING_M_S)
        return replace(frame, in_gap=in_gap)

    def _usual_s(self) -> float:
        return median(self._periods_s) if self._periods_s else 0.0
