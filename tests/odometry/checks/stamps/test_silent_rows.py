"""Rows that are missing while the robot goes on as before: nothing contradicts the held speed."""

from dataclasses import replace

import numpy as np
import pytest

from odometry.checks.recording import check_recording
from tests.odometry.checks.drives import AT_REST_S, drive, pausing
from tests.odometry.checks.faulty import put


def without(run, begin_s, lasts_s):
    at_s = run.odometry.stamps_s
    kept = np.flatnonzero((at_s <= begin_s) | (at_s >= begin_s + lasts_s))
    return replace(run, odometry=run.odometry.rows(kept))


def noted(run):
    return [f for f in check_recording(run).findings if f.name == "odometry_silent"]


def even():
    return drive(np.full(2000, 0.6), np.full(2000, 0.2))


def test_time_without_rows_is_noted_where_the_robot_moves():
    run = without(even(), 40.0, 3.0)
    (found,) = noted(run)
    assert "3.0 s in 1 place" in found.seen
    assert found.spans_s[0] == pytest.approx((40.0, 43.0))


@pytest.mark.parametrize(
    "run",
    [even(), without(even(), 40.0, 0.8), without(pausing(), AT_REST_S[0] + 2, 6.0)],
    ids=["whole", "short", "at rest"],
)
def test_a_short_time_and_a_robot_at_rest_are_no_loss(run):
    assert noted(run) == []


def test_where_the_poses_contradict_it_has_its_own_name():
    run = without(pausing(), AT_REST_S[0] - 5.0, 10.0)
    assert "odometry_gap" in [f.name for f in check_recording(run).findings]
    assert noted(run) == []


def test_a_log_of_changes_is_none():
    """A row where the speed changes, after times of any length."""
    run, rng = even(), np.random.default_rng(0)
    rows = np.cumsum(rng.geometric(0.1, 250))
    rows = rows[rows < len(run.odometry)]
    run = replace(run, odometry=run.odometry.rows(rows))
    steps = 0.1 * np.arange(len(rows)) % 0.3
    run = put(run, "odometry", v_left=0.5 + steps, v_right=0.7 + steps)
    assert noted(without(run, 40.0, 10.0)) == []
