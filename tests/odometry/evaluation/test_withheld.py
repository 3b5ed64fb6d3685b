"""Which poses are kept from the filter, and that it never sees them."""

from itertools import pairwise

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from odometry.estimation.icr_ekf import IcrEkf
from odometry.evaluation.score import JUDGED_EVERY_S, SILENT_S, choose, withhold
from odometry.recording.run import Run
from odometry.replays.pipeline import ConstantTerrain, replay


def run_with(make_run, stamps_s, yaw="0", end_s=12.0):
    odometry = "".join(f"{t:.2f},1,1\n" for t in np.arange(0, end_s, 0.25))
    poses = "".join(f"{t:.6f},{t:.6f},0,{yaw}\n" for t in stamps_s)
    return Run.read(make_run(odometry="t,v_left,v_right\n" + odometry, pose="t,x,y,yaw\n" + poses))


def given_s(withheld):
    there = np.isfinite(withheld.run.pose["x"])
    return withheld.run.pose.stamps_s[there]


def test_dense_poses_lose_a_second_in_two(make_run):
    run = run_with(make_run, np.arange(0, 11, 0.125))
    found = withhold(run, 0.0, 12.0)
    np.testing.assert_allclose(found.judged.stamps_s, [2, 4, 6, 8, 10])
    there = given_s(found)
    for judged_s in (2, 4, 6, 8, 10):
        assert not np.any((there > judged_s - 1) & (there <= judged_s))
    assert found.poses == 5 * 8
    assert len(there) == len(run.pose) - 40


@pytest.mark.parametrize(
    ("period_s", "judged"), [(1.0, [2, 4, 6, 8, 10]), (3.0, [3, 9]), (5.0, [5])]
)
def test_of_sparse_poses_one_is_always_given_between_two(make_run, period_s, judged):
    """A run of 5 s period has 0, 5, 10: only one could be withheld, which evaluates nothing."""
    found = withhold(run_with(make_run, np.arange(0, 11, period_s)), 0.0, 12.0)
    if len(judged) < 2:
        assert found is None
        return
    np.testing.assert_allclose(found.judged.stamps_s, judged)


@given(st.lists(st.floats(0.02, 4.0), min_size=2, max_size=60))
@settings(max_examples=50)
def test_what_is_judged_is_alone_however_the_poses_come(steps_s):
    stamps_s = np.cumsum(steps_s)
    judged, kept = choose(stamps_s)
    assert kept[0]
    assert not np.any(judged & kept)
    rows = np.flatnonzero(judged)
    assert np.all(np.diff(stamps_s[rows], prepend=stamps_s[0]) >= JUDGED_EVERY_S - 1e-9)
    for begin, row in pairwise([0, *rows]):
        assert kept[begin:row].any()
        assert not np.any(
            kept & (stamps_s > stamps_s[row] - SILENT_S) & (stamps_s <= stamps_s[row])
        )


def test_positions_without_yaw_judge_too(make_run):
    found = withhold(run_with(make_run, np.arange(0, 11, 0.5), yaw=""), 0.0, 12.0)
    assert np.isnan(found.judged.poses[:, 2]).all()
    np.testing.assert_allclose(found.judged.poses[:, 0], found.judged.stamps_s)


def test_poses_before_the_replay_are_not_touched(make_run):
    run = run_with(make_run, np.arange(0, 11, 0.5))
    found = withhold(run, 5.0, 9.0)
    np.testing.assert_allclose(found.judged.stamps_s, [7, 9])
    assert withhold(run, 9.0, 12.0) is None


def test_a_wrong_pose_that_is_withheld_changes_no_estimate(make_run):
    """The filter gets everything but the withheld poses: same answer if those are nonsense."""
    run = run_with(make_run, np.arange(0, 11, 0.5))
    found = withhold(run, 0.0, 12.0)
    wrong = run_with(make_run, np.arange(0, 11, 0.5))
    rows = np.isnan(found.run.pose["x"])
    wrong.pose["x"][rows] += 50.0
    again = withhold(wrong, 0.0, 12.0)
    assert again.judged.poses[0, 0] == pytest.approx(found.judged.poses[0, 0] + 50)
    means = [replay(one.run, IcrEkf(0.5), ConstantTerrain("a")).means for one in (found, again)]
    np.testing.assert_array_equal(*means)
