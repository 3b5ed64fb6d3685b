"""A reference that is corrected by a little, from one row to the next."""

import re

import numpy as np
import pytest

from odometry.checks.findings.finding import Level
from odometry.checks.recording import check_recording
from tests.odometry.checks.drives import turning_all_round
from tests.odometry.checks.faulty import put

AT = 400  # row of pose.csv from which poses are corrected


@pytest.fixture(scope="module")
def driven():
    return turning_all_round()


def stepping(run, size_m=0.0, turned_rad=0.0, rows=1):
    """Poses moved aside, and turned about the place where they are, over so many rows."""
    x, y, yaw = run.pose.stack("x", "y", "yaw").T
    share = np.clip((np.arange(len(x)) - AT + 1) / rows, 0, 1)
    angle = turned_rad * share
    from_x, from_y = x - x[AT], y - y[AT]
    return put(
        run,
        "pose",
        x=x[AT]
        + np.cos(angle) * from_x
        - np.sin(angle) * from_y
        - size_m * share * np.sin(yaw[AT]),
        y=y[AT]
        + np.sin(angle) * from_x
        + np.cos(angle) * from_y
        + size_m * share * np.cos(yaw[AT]),
        yaw=yaw + angle,
    )


def found_in(run):
    return {finding.name: finding for finding in check_recording(run).findings}


@pytest.mark.parametrize(
    ("change", "name", "size"),
    [({"size_m": 0.4}, "pose_jumps", 0.4), ({"turned_rad": 0.25}, "yaw_jumps", 14.3)],
)
def test_a_correction_is_noted_with_its_size_and_moment(driven, change, name, size):
    found = found_in(stepping(driven, **change))[name]
    at_s = driven.pose.stamps_s[AT] - driven.began_s
    assert found.level == Level.NOTE
    assert float(re.search(r"time: (\S+) ", found.seen)[1]) == pytest.approx(size, rel=0.25)
    assert found.spans_s[0][0] == pytest.approx(at_s, abs=0.11)


def test_yaw_that_is_missing_in_a_row_hides_no_step_of_the_others(driven):
    run = stepping(driven, turned_rad=0.25)
    yaw = run.pose["yaw"].copy()
    yaw[50] = np.nan
    assert "yaw_jumps" in found_in(put(run, "pose", yaw=yaw))


def test_positions_alone_that_are_corrected_are_noted(driven):
    alone = put(stepping(driven, size_m=0.5), "pose", yaw=np.full(len(driven.pose), np.nan))
    assert "pose_jumps" in found_in(alone)


@pytest.mark.parametrize("change", [{}, {"size_m": 0.1}, {"size_m": 0.3, "rows": 20}])
def test_small_and_slow_corrections_are_none(driven, change):
    assert not {"pose_jumps", "yaw_jumps"} & found_in(stepping(driven, **change)).keys()


def test_steps_between_windows_are_none(driven):
    window = (np.arange(len(driven.pose)) >= AT).astype(float)
    cut = put(stepping(driven, size_m=0.3, turned_rad=0.1), "pose", window=window)
    assert not {"pose_jumps", "yaw_jumps"} & found_in(cut).keys()
