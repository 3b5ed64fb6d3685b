"""Windows are cut by time, whatever the stamps of the poses."""

from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from odometry.errors import WindowError
from odometry.tables.table import Table
from odometry.windows.dense.dense import dense_windows_of

HORIZON_S = 2.0
DURATION_S = 60.0


@pytest.fixture(scope="module")
def run(make_scene):
    return make_scene(3, duration_s=DURATION_S).run


def scene_at(run, stamps_s):
    """The run with poses at other stamps."""
    columns = {
        name: np.interp(stamps_s, run.pose.stamps_s, run.pose[name]) for name in ("x", "y", "yaw")
    }
    columns = {"t": stamps_s, **columns}
    pose = Table(Path("pose.csv"), columns, np.arange(len(stamps_s)) + 2)
    return dense_windows_of(replace(run, pose=pose), HORIZON_S)


def lasting_s(scene):
    return np.diff(scene.pose_s[scene.windows[:, [0, -1]]], axis=1)[:, 0]


@pytest.mark.parametrize("rate_hz", [1, 2, 5, 10, 20])
def test_even_stamps_make_windows_of_as_many_steps_as_the_horizon_has(run, rate_hz):
    """At 10 Hz 20 steps of 0.1 s, from the first pose half a second into the run on."""
    stamps_s = np.arange(int((DURATION_S - 0.1) * rate_hz)) / rate_hz
    scene = scene_at(run, stamps_s)
    steps = int(HORIZON_S * rate_hz)
    inside = (stamps_s >= 0.5) & (stamps_s <= run.odometry.stamps_s[-1] - 0.5)
    usable = np.flatnonzero(inside)
    starts = usable[:-steps:steps]
    np.testing.assert_array_equal(scene.windows, starts[:, None] + np.arange(steps + 1))


def test_no_window_is_lost_where_every_third_pose_is_missing(run):
    even_s = np.arange(0.0, DURATION_S - 0.1, 0.2)
    stamps_s = even_s[(even_s < 20.0) | (even_s > 40.0) | (np.arange(len(even_s)) % 3 > 0)]
    scene = scene_at(run, stamps_s)
    np.testing.assert_array_equal(scene.windows[1:, 0], scene.windows[:-1, -1])
    assert lasting_s(scene) == pytest.approx(HORIZON_S, abs=0.2 + 1e-9)
    assert scene.pose_s[scene.windows[-1, -1]] > DURATION_S - 0.6 - HORIZON_S
    assert len(scene) >= len(scene_at(run, even_s)) - 1


@pytest.mark.parametrize("rate_hz", [50, 20])
def test_a_burst_of_poses_is_thinned_to_the_rate_of_the_rest(run, rate_hz):
    """The same for 5 Hz and for a burst: eleven poses at even distances over two seconds."""
    even_s = np.arange(0.0, DURATION_S - 0.1, 0.2)
    burst_s = np.arange(20.6, 38.61, 1 / rate_hz)  # nine windows
    scene = scene_at(run, np.unique(np.round(np.concatenate([even_s, burst_s]), 9)))
    assert scene.windows.shape == (len(scene_at(run, even_s)), 11)
    assert lasting_s(scene) == pytest.approx(HORIZON_S)
    np.testing.assert_allclose(np.diff(scene.pose_s[scene.windows], axis=1), 0.2, atol=0.02 + 1e-9)


def test_a_burst_that_is_the_rule_sets_the_number_of_poses(run):
    """Few windows of fewer poses are dropped; the others keep all that was measured."""
    stamps_s = np.arange(0.0, DURATION_S - 0.1, 0.1)
    sparse = (stamps_s > 20.55) & (stamps_s < 22.45)
    kept = ~sparse | (np.arange(len(stamps_s)) % 4 == 0)
    scene = scene_at(run, stamps_s[kept])
    assert scene.windows.shape == (len(scene_at(run, stamps_s)) - 1, 21)
    np.testing.assert_array_equal(np.diff(scene.windows, axis=1), 1)
    assert not ((scene.start_s > 20.4) & (scene.start_s < 22.4)).any()


@given(st.floats(0.05, 0.6), st.floats(0.0, 0.9), st.integers(0, 10**6))
def test_windows_last_as_near_the_horizon_as_the_stamps_allow(run, period_s, jitter, seed):
    """Beside all poses of the run; within a quarter of the horizon, and none overlaps another."""
    rng = np.random.default_rng(seed)
    stamps_s = np.cumsum(period_s * rng.uniform(1 - jitter, 1 + jitter, int(55.0 / period_s)))
    scene = scene_at(run, stamps_s[stamps_s < DURATION_S - 0.1])
    assert (np.diff(scene.windows, axis=1) > 0).all()
    assert (scene.windows[1:, 0] >= scene.windows[:-1, -1]).all()
    off_s = np.abs(lasting_s(scene) - HORIZON_S)
    assert (off_s <= 0.25 * HORIZON_S).all()
    others_s = np.abs(scene.pose_s - scene.start_s[:, None] - HORIZON_S)
    others_s[:, scene.pose_s > scene.time_s[-1] - 0.5] = np.inf
    np.testing.assert_allclose(off_s, others_s.min(axis=1), atol=1e-12)


def test_poses_farther_apart_than_half_the_horizon_are_too_few(run):
    """Every second three poses make a window; every two seconds there are but two."""
    assert scene_at(run, np.arange(0.5, DURATION_S, 1.0)).windows.shape[1] == 3
    with pytest.raises(WindowError, match=r"no window of 2 s with 3 .*longer horizon"):
        scene_at(run, np.arange(0.5, DURATION_S, 2.0))
