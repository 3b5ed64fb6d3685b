"""How much of each reversal of a tread lies in a window of turns."""

import tracemalloc
from types import SimpleNamespace

import numpy as np

from odometry.checks.treads.play import _unread

PERIOD_S, WINDOW_S = 0.1, 0.7


def reversing(rows):
    """A tread that goes to and fro, at rest between or not, and windows of turns."""
    stamps_s = PERIOD_S * np.arange(rows)
    speeds = np.round(np.sin(stamps_s) + 0.2 * np.sin(stamps_s / 7), 1)
    evidence = SimpleNamespace(
        speeds_m_s=np.stack([speeds, speeds], axis=-1), stamps_s=stamps_s, fastest_m_s=1.2
    )
    start_s = np.arange(0, stamps_s[-1] - WINDOW_S, WINDOW_S / 2)
    return evidence, SimpleNamespace(start_s=start_s, lasts_s=np.full(len(start_s), WINDOW_S))


def test_each_reversal_is_spread_over_the_time_without_a_reading_of_either_sign():
    evidence, turns = reversing(700)
    speeds = evidence.speeds_m_s[:, 0]
    expected = np.zeros(len(turns.start_s))
    last_row = None
    for row in np.flatnonzero(speeds):
        if last_row is not None and speeds[row] * speeds[last_row] < 0:
            begin_s, end_s = evidence.stamps_s[[last_row, row]]
            for window, start_s in enumerate(turns.start_s):
                both_s = min(start_s + WINDOW_S, end_s) - max(start_s, begin_s)
                share = max(both_s, 0.0) / (end_s - begin_s)
                expected[window] += np.sign(speeds[row]) * share
        last_row = row
    np.testing.assert_allclose(_unread(evidence, turns, 0), expected, atol=1e-12)


def test_memory_grows_with_the_windows_and_not_with_windows_times_reversals():
    evidence, turns = reversing(20_000)
    tracemalloc.start()
    try:
        _unread(evidence, turns, 0)
        _, peak = tracemalloc.get_traced_memory()
    finally:
        tracemalloc.stop()
    assert peak < 1000 * len(turns.start_s)
