"""Windows shorter than asked are counted from stamps and stretches that are known."""

from collections import Counter
from dataclasses import replace

import numpy as np
import pytest

from odometry.identification.plausibility import WHY, short_windows
from odometry.windows.recorded.record import CHANGE_OF_WINDOW, POSE_GAP, STATIONARY
from odometry.windows.travel.windows import windows_of


@pytest.fixture(scope="module")
def windows(winding, stated):
    return windows_of([winding], stated)


def test_windows_as_long_as_asked_need_no_word(windows, stated):
    assert short_windows(windows, stated) == ""


def test_half_may_be_shorter_without_a_word(windows, stated):
    count = len(windows)
    few = count // 2
    for short, silent in ((few, True), (few + 1, False)):
        travel_m = np.where(np.arange(count) < short, 0.5, 2.1)
        said = short_windows(replace(windows, travel_m=travel_m), stated)
        assert (said == "") == silent
    assert said.startswith(
        f"{few + 1} of {count} windows are shorter than the 2 m of the horizon (0.50 m"
    )


@pytest.mark.parametrize("reason", [CHANGE_OF_WINDOW, POSE_GAP])
def test_what_cuts_most_of_them_is_named(windows, stated, reason):
    """Stationary windows are shorter for no cut."""
    left_out = Counter({STATIONARY: 50, reason: 9})
    short = replace(windows, travel_m=windows.travel_m / 4, left_out=left_out)
    assert WHY[reason] in short_windows(short, stated)
    alone = replace(short, left_out=Counter({STATIONARY: 50}))
    assert "the runs have no more" in short_windows(alone, stated)


def test_windows_by_time_are_judged_by_time(winding, stated):
    by_time = replace(stated, horizon_s=1.5)
    windows = windows_of([winding], by_time)
    assert short_windows(windows, by_time) == ""
    said = short_windows(windows, replace(stated, horizon_s=30.0))
    lasted_s = [
        windows.steps_s[a:b].sum() for a, b in zip(windows.first, windows.last, strict=True)
    ]
    assert f"than the 30 s of the horizon ({np.mean(lasted_s):.2f} s on average)" in said
