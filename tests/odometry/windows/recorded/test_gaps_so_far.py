"""Gaps as they are known while the robot drives."""

import numpy as np
import pytest

from odometry.recording.frames import Frame
from odometry.windows.recorded.gaps import GapsSoFar


def told(stamps_s, rows, speed_m_s=0.5):
    gaps = GapsSoFar()
    speeds = np.full(2, speed_m_s)
    frames = [Frame(t, speeds, row, None, None) for t, row in zip(stamps_s, rows, strict=True)]
    return [gaps.marked(frame).in_gap for frame in frames]


@pytest.mark.parametrize(("period_s", "longest_s"), [(0.02, 1.0), (0.1, 2.0), (0.5, 10.0)])
def test_a_hold_is_a_gap_beyond_one_second_and_twenty_periods(period_s, longest_s):
    """A hold is no gap until it is longer; the row that ends it still ends a gap."""
    stamps_s = [*(period_s * np.arange(50))]
    last_s = stamps_s[-1]
    later_s = [last_s + 0.99 * longest_s, last_s + 1.01 * longest_s, last_s + 1.1 * longest_s]
    after_s = later_s[-1] + period_s
    stamps = [*stamps_s, *later_s, after_s]
    rows = [*range(50), 49, 49, 50, 51]
    assert told(stamps, rows) == [False] * 51 + [True, True, False]


def test_a_robot_that_stands_has_no_gap():
    assert told([0.0, 0.1, 0.2, 30.0], [0, 1, 2, 3], speed_m_s=0.0) == [False] * 4


def test_one_long_hold_does_not_make_long_holds_usual():
    stamps_s = [*(0.1 * np.arange(10)), 9.0, 9.1, 9.2, 20.0]
    assert told(stamps_s, range(14)) == [False] * 10 + [True, False, False, True]
