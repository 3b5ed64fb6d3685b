"""Gaps of odometry as they are known while the robot drives: by the length of a hold alone."""

from collections import deque
from dataclasses import replace
from statistics import median

import numpy as np

from odometry.frames import Frame
from odometry.windows.gaps import LONG_PERIODS, LONG_S, STANDING_M_S

PERIODS = 100  # latest periods of odometry whose median is the usual one


class GapsSoFar:
    """Decides of each frame whether the speeds that led to it were held for too long to be known.

    Too long is more than 1 s and than 20 usual periods with a tread turning, as in
    `odometry_gaps`; what other sensors say of the held speeds is not asked, because they say it
    later.
    """

    def __init__(self) -> None:
        self._periods_s: deque[float] = deque(maxlen=PERIODS)
        self._row = -1
        self._stamp_s = 0.0
        self._turning = False

    def told(self, frame: Frame) -> Frame:
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
