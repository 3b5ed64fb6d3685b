"""How many windows there are not, and why: counted by hand, and in words."""

from collections import Counter
from dataclasses import replace

import numpy as np
import pytest

from odometry.errors import WindowError
from odometry.windows.config import WindowConfig
from odometry.windows.dense.dense import dense_windows_of
from odometry.windows.recorded.record import (
    CHANGE_OF_TERRAIN,
    CHANGE_OF_WINDOW,
    POSE_GAP,
    STATIONARY,
    straddling,
    summed,
    words,
)
from odometry.windows.travel.windows import windows_of


def test_a_window_counts_under_the_first_break_that_it_straddles():
    """Poses 0 to 9, "a" between 2 and 3, "b" between 3 and 4 and between 8 and 9."""
    breaks = np.full(9, "", dtype=object)
    breaks[[2, 3, 8]] = "a", "b", "b"
    first, last = np.array([0, 0, 2, 3, 4, 4, 7]), np.array([2, 3, 4, 4, 6, 8, 9])
    assert straddling(breaks, first, last) == Counter(a=2, b=2)
    assert straddling(breaks[:2], first[:1], last[:1]) == Counter()


def test_words_begin_with_the_most_frequent_reason():
    counts = summed([Counter(seldom=1), Counter(often=3), Counter(often=1)])
    assert words(counts) == "5 windows left out: often (4), seldom (1)"
    assert words(Counter(once=1)) == "1 window left out: once (1)"
    assert words(Counter()) == ""


def with_pose(run, **columns):
    return replace(run, pose=replace(run.pose, columns={**run.pose.columns, **columns}))


def test_windows_tell_what_a_recording_lost(winding):
    """Each break lies in one of the windows of 2 s that follow one another over the run."""
    config = WindowConfig(horizon_s=2.0)
    assert not windows_of([winding], config).left_out
    t = winding.pose.stamps_s
    numbered = with_pose(winding, window=np.searchsorted([30.0, 60.0, 90.0], t).astype(float))
    found = windows_of([numbered], config)
    assert found.left_out == {CHANGE_OF_WINDOW: 3}
    assert found.where(np.zeros(len(found), dtype=bool)).left_out == found.left_out
    kept = (t < 20.0) | (t > 25.0)
    lost = replace(winding, pose=replace(winding.pose, columns={}, lines=winding.pose.lines[kept]))
    lost = with_pose(lost, **{name: c[kept] for name, c in winding.pose.columns.items()})
    assert windows_of([lost, winding], config).left_out == {POSE_GAP: 1}
    assert dense_windows_of(lost, 2.0).left_out[POSE_GAP] <= 1


def test_standing_and_other_terrain_are_reported(winding):
    t = winding.odometry.stamps_s
    names = np.where(t < 50.0, "ice", "grass").astype(object)
    standing = (t > 70.0) & (t < 80.0)
    speeds = {
        name: np.where(standing, 0.0, winding.odometry[name]) for name in ("v_left", "v_right")
    }
    columns = {**winding.odometry.columns, **speeds, "terrain": names}
    run = replace(winding, odometry=replace(winding.odometry, columns=columns))
    found = windows_of([run], WindowConfig(horizon_s=2.0)).left_out
    assert found[CHANGE_OF_TERRAIN] == 1
    assert found[STATIONARY] in {3, 4}


def test_an_error_says_which_reason_was_the_most_frequent(winding):
    """Every pose is a window of its source."""
    alone = with_pose(winding, window=np.arange(len(winding.pose), dtype=float))
    with pytest.raises(
        WindowError, match=r"; \d+ windows left out: change of `window` \(\d+\); choose"
    ):
        windows_of([alone], WindowConfig())
    with pytest.raises(
        WindowError, match=r"; \d+ windows left out: change of `window` \(\d+\); choose"
    ):
        dense_windows_of(alone, 2.0)
