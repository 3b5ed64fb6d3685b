"""Windows of a run: whole, of poses that belong together, and refused where there are none."""

from dataclasses import replace

import numpy as np
import pytest

from odometry.errors import WindowError
from odometry.gap.prepare.pieces import numbered_pieces, pieces
from odometry.windows.dense.dense import dense_windows_of, thinned
from odometry.windows.recorded.record import ODOMETRY_GAP

TWO_SECONDS = 10  # steps between poses at 5 Hz


@pytest.fixture
def run(make_scene):
    return make_scene(3, duration_s=60.0).run


def with_poses(run, chosen=slice(None), **columns):
    pose = replace(run.pose, columns={**run.pose.columns, **columns})
    return replace(run, pose=pose.rows(chosen))


def test_windows_follow_one_another_over_the_run(run):
    scene = dense_windows_of(run, 2.0)
    assert scene.windows.shape == (29, TWO_SECONDS + 1)
    np.testing.assert_array_equal(np.diff(scene.windows, axis=1), 1)
    np.testing.assert_array_equal(scene.windows[1:, 0], scene.windows[:-1, -1])
    assert scene.start_s[0] == pytest.approx(0.6)  # the first pose half a second into the run
    assert scene.pose_s[scene.windows[-1, -1]] <= run.odometry.stamps_s[-1] - 0.5


def test_the_measured_motion_is_seen_from_each_windows_first_pose(run):
    scene = dense_windows_of(run, 2.0)
    x, y, yaw = run.pose.stack("x", "y", "yaw").T
    for k in (0, 13, 28):
        first = np.searchsorted(run.pose.stamps_s, scene.start_s[k])
        others = slice(first + 1, first + TWO_SECONDS + 1)
        moved = (x[others] - x[first] + 1j * (y[others] - y[first])) * np.exp(-1j * yaw[first])
        expected = np.column_stack([moved.real, moved.imag, yaw[others] - yaw[first]])
        np.testing.assert_allclose(scene.measured[k], expected, atol=1e-12)


def test_another_horizon_makes_other_windows(run):
    scene = dense_windows_of(run, 5.0)
    assert scene.windows.shape == (11, 26)


def test_no_window_straddles_a_gap_between_poses(run):
    t = run.pose.stamps_s
    scene = dense_windows_of(with_poses(run, (t < 21.0) | (t > 26.0)), 2.0)
    ends_s = scene.pose_s[scene.windows[:, -1]]
    assert ((ends_s < 21.0) | (scene.start_s > 26.0)).all()
    assert (ends_s - scene.start_s == pytest.approx(2.0)) is True
    assert len(scene) == 26


def test_no_window_straddles_a_change_of_window(run):
    t = run.pose.stamps_s
    for number, straddling in ((np.where(t < 21.0, 1.0, 2.0), 0), (np.ones(len(t)), 1)):
        scene = dense_windows_of(with_poses(run, window=number), 2.0)
        ends_s = scene.pose_s[scene.windows[:, -1]]
        assert ((ends_s >= 21.0) & (scene.start_s < 21.0)).sum() == straddling
        assert len(scene) == 29


def without_two_seconds(run, row):
    """The run, of which 40 rows of odometry after this one are missing, and when."""
    t = run.odometry.stamps_s
    kept = (np.arange(len(t)) <= row) | (np.arange(len(t)) > row + 40)
    return replace(run, odometry=run.odometry.rows(kept)), t[row], t[row + 41]


def test_no_window_straddles_a_gap_in_odometry(run):
    """Where the speeds change most in two seconds."""
    speeds = run.odometry.stack("v_left", "v_right")
    row = int(np.abs(speeds[41:] - speeds[:-41]).max(axis=1).argmax())
    cut, begin_s, end_s = without_two_seconds(run, row)
    windows = dense_windows_of(cut, 2.0)
    ends_s = windows.pose_s[windows.windows[:, -1]]
    assert ((ends_s <= begin_s) | (windows.start_s >= end_s)).all()
    assert windows.left_out[ODOMETRY_GAP] in {1, 2}


def test_windows_go_on_over_speeds_that_were_held(run):
    """Where they hardly change."""
    speeds = run.odometry.stack("v_left", "v_right")
    held = np.lib.stride_tricks.sliding_window_view(speeds, 42, axis=0)
    row = int(np.ptp(held, axis=-1).max(axis=1).argmin())
    windows = dense_windows_of(without_two_seconds(run, row)[0], 2.0)
    assert len(windows) == len(dense_windows_of(run, 2.0))
    assert not windows.left_out


def test_a_change_of_terrain_is_kept_and_cuts_nothing(make_scene):
    def terrain(t):
        return np.where(t < 21.3, "stone", "wet grass")

    scene = make_scene(3, duration_s=60.0, terrain=terrain)
    assert len(scene) == 29
    ends_s = scene.pose_s[scene.windows[:, -1]]
    assert ((scene.start_s < 21.3) & (ends_s > 21.3)).sum() == 1
    np.testing.assert_array_equal(scene.inputs.terrain, terrain(scene.time_s + 1e-9))


def test_samples_are_in_force_until_the_next(run):
    scene = dense_windows_of(run, 2.0)
    assert scene.steps_s.sum() == pytest.approx(scene.time_s[-1])
    speeds = run.odometry.stack("v_left", "v_right")
    travel_m = (np.abs(speeds[:-1]).mean(axis=1) * np.diff(run.odometry.stamps_s)).sum()
    assert scene.travel_m[-1] == pytest.approx(travel_m)


def test_a_run_shorter_than_a_window_is_refused(run):
    """A longer window fits into it even less."""
    with pytest.raises(WindowError, match=r"no window of 2 s with 3 .*: record for longer"):
        dense_windows_of(with_poses(run, run.pose.stamps_s < 2.2), 2.0)


def test_a_run_without_poses_is_refused(run):
    with pytest.raises(WindowError, match=r"run.*pose\.csv"):
        dense_windows_of(replace(run, pose=None), 2.0)


def test_pieces_and_thinning(run):
    scene = dense_windows_of(run, 2.0)
    np.testing.assert_array_equal(pieces(scene, 10.0), (scene.start_s / 10.0).astype(int))
    fewer = thinned(scene, 10)
    assert len(fewer) == 10
    np.testing.assert_array_equal(fewer.windows[[0, -1]], scene.windows[[0, -1]])
    assert np.diff(fewer.start_s) == pytest.approx(56.0 / 9, abs=2.0)
    assert thinned(scene, 29) is scene


def test_pieces_of_several_runs_have_numbers_of_their_own(make_scene):
    """One number for every pair of a run and a piece of it, also where a run starts late."""
    scenes = [make_scene(seed, duration_s=60.0) for seed in (3, 4, 5)]
    scenes[1] = scenes[1].where(scenes[1].start_s > 25.0)
    found = numbered_pieces(scenes, 10.0)
    pairs = [(i, p) for i, scene in enumerate(scenes) for p in pieces(scene, 10.0)]
    assert len(found) == sum(map(len, scenes))
    assert len(set(zip(found, pairs, strict=True))) == len(set(pairs)) == len(set(found))


@pytest.mark.parametrize(
    ("horizon_s", "rest_s", "are_left_out"),
    [(1.0, 30.0, False), (1.0, 300.0, True), (2.0, 300.0, False)],
)
def test_windows_of_a_robot_that_mostly_stands_are_those_in_which_it_moves_if_there_are_enough(
    run, horizon_s, rest_s, are_left_out
):
    driven = dense_windows_of(run, horizon_s)
    later_s = run.odometry.stamps_s[-1] + np.arange(0.05, rest_s, 0.05)
    treads = dict.fromkeys(("v_left", "v_right"), np.zeros(len(later_s)))
    odometry = extended(run.odometry, t=later_s, **treads)
    last = {name: run.pose[name][-1] for name in ("x", "y", "yaw")}
    poses = extended(run.pose, t=later_s[::4], **last)
    rested = dense_windows_of(replace(run, odometry=odometry, pose=poses), horizon_s)
    assert (rested.left_out["treads stationary"] > 0) == are_left_out
    more = len(rested.windows) - len(driven.windows)
    assert more == pytest.approx(0 if are_left_out else rest_s / horizon_s, abs=2)


def extended(table, t, **added):
    """The table with rows added at its end; columns that are not named are 0 there."""
    columns = {
        name: np.append(values, np.broadcast_to(added.get(name, 0.0), len(t)))
        for name, values in table.columns.items()
        if name != "t"
    }
    columns = {"t": np.append(table.stamps_s, t), **columns}
    return replace(table, columns=columns, lines=np.arange(len(columns["t"])) + 2)
