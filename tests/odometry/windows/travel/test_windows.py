from itertools import pairwise
from pathlib import Path

import numpy as np
import pytest
from hypothesis import assume, given
from hypothesis import strategies as st

from odometry.errors import WindowError
from odometry.models.icr import Icr
from odometry.recording.run import Robot, Run
from odometry.tables.table import Table
from odometry.windows.config import WindowConfig
from odometry.windows.recorded.gaps import odometry_gaps
from odometry.windows.travel.motion import linearised_window_motion, window_motion
from odometry.windows.travel.windows import windows_of

VALUES = np.array([0.45, -0.36, 0.06, 0.97, 0.93])
POSE_GAP_S = 0.5
WIDE_M = 20.0  # so wide a robot turns too little for the count of its turns to be in doubt


def run_of(name, odometry, pose):
    """A run of tables (dicts of columns) that never were files."""
    tables = [
        Table(Path(name) / f"{kind}.csv", columns, np.arange(2, 2 + len(columns["t"])))
        for kind, columns in (("odometry", odometry), ("pose", pose))
    ]
    return Run(Path(name), Robot(WIDE_M), {}, *tables)


@st.composite
def runs(draw, name="drawn"):
    """Stamps with pauses, changing speeds and attitude, names of grounds, chained poses."""
    rng = np.random.default_rng(draw(st.integers(0, 2**32)))
    count, poses = draw(st.integers(5, 120)), draw(st.integers(5, 60))
    periods_s = np.where(rng.random(count) < draw(st.floats(0, 0.1)), 2.1, 0.1)
    pauses_s = np.where(rng.random(poses) < draw(st.floats(0, 0.2)), 0.7, 0.25)
    odometry_s, pose_s = np.cumsum(periods_s), 1.0 + np.cumsum(pauses_s) - rng.random()
    standing = (rng.random(count) > 0.9) & (np.append(periods_s[1:], 0.1) < 1.0)
    speeds = rng.uniform(-1, 1, (count, 2)) * ~standing[:, None]
    odometry = {
        "t": odometry_s,
        "v_left": speeds[:, 0],
        "v_right": speeds[:, 1],
        "roll": rng.uniform(-0.3, 0.3, count),
        "pitch": rng.uniform(-0.3, 0.3, count),
        "terrain": np.array(["ice", "sand"])[np.cumsum(rng.random(count) < 0.03) % 2],
    }
    window = np.cumsum(rng.random(poses) < 0.05).astype(float)
    columns = dict(zip(["x", "y", "yaw"], 0.3 * rng.normal(size=(3, poses)), strict=True))
    return run_of(name, odometry, {"t": pose_s, **columns, "window": window})


configs = st.builds(
    WindowConfig,
    horizon_m=st.floats(0.05, 2),
    horizon_s=st.sampled_from([0.0, 0.4, 1.0]),
    stride=st.sampled_from([0.3, 0.5, 1.0, 1.7]),
    shortest=st.floats(0.05, 1),
    pose_gap_s=st.just(POSE_GAP_S),
)


def travel_between(run, begin_s, end_s):
    """The integral of (|v_left| + |v_right|) / 2, row by row."""
    stamps_s, total = run.odometry.stamps_s, 0.0
    for i, begin in enumerate(stamps_s):
        end = stamps_s[i + 1] if i + 1 < len(stamps_s) else begin
        held_s = max(min(end, end_s) - max(begin, begin_s), 0.0)
        speed = (abs(run.odometry["v_left"][i]) + abs(run.odometry["v_right"][i])) / 2
        total += speed * held_s
    return total


def breaks_between(run, earlier, later, pose_gap_s):
    """Whether two neighbouring poses (rows of pose.csv) belong to different stretches."""
    odometry_s, begin_s, end_s = run.odometry.stamps_s, *run.pose.stamps_s[[earlier, later]]
    paused = any(before < end_s and begin_s < after for before, after in odometry_gaps(run).spans_s)
    rows = [max(np.flatnonzero(odometry_s <= stamp)) for stamp in (begin_s, end_s)]
    grounds = set(run.odometry["terrain"][rows[0] : rows[1] + 1])
    window = run.pose["window"][[earlier, later]]
    return end_s - begin_s > pose_gap_s or paused or len(grounds) > 1 or np.ptp(window) > 0


def stretches_of(run):
    """Lists of rows of pose.csv, in the time of odometry, that no break parts."""
    odometry_s, pose_s = run.odometry.stamps_s, run.pose.stamps_s
    inside = np.flatnonzero((pose_s >= odometry_s[0]) & (pose_s <= odometry_s[-1]))
    assume(len(inside) > 1)
    stretches = [[inside[0]]]
    pose_gap_s = max(POSE_GAP_S, 5 * np.median(np.diff(pose_s[inside])))
    for earlier, later in pairwise(inside):
        if breaks_between(run, earlier, later, pose_gap_s):
            stretches.append([])
        stretches[-1].append(later)
    return stretches


def derivative_of_motion(model, values, windows):
    return linearised_window_motion(model, values, windows)[1]


def windows_or_skip(runs, config):
    try:
        return windows_of(runs, config)
    except WindowError:
        assume(condition=False)


@given(run=runs(), config=configs)
def test_windows_lie_in_stretches_and_reach_the_horizon(run, config):
    """Or are the whole of a stretch that is shorter. The end is the first pose that reaches it."""
    stretches = stretches_of(run)
    windows = windows_or_skip([run], config)
    inside_s = run.pose.stamps_s[np.concatenate(stretches)]

    def size(first, last):
        begin_s, end_s = run.pose.stamps_s[[first, last]]
        return end_s - begin_s if config.horizon_s else travel_between(run, begin_s, end_s)

    horizon = config.horizon_s or config.travel_m
    for k in range(len(windows)):
        begin_s, end_s = inside_s[[windows.first_pose[k], windows.last_pose[k]]]
        assert windows.start_s[k] == begin_s
        assert windows.steps_s[windows.first[k] : windows.last[k]].sum() == pytest.approx(
            end_s - begin_s, abs=1e-9
        )
        assert windows.travel_m[k] == pytest.approx(travel_between(run, begin_s, end_s), abs=1e-9)
        first, last = np.searchsorted(run.pose.stamps_s, [begin_s, end_s])
        (stretch,) = [rows for rows in stretches if first in rows]
        assert last in stretch
        if size(first, last) < horizon - 2e-9:
            assert [first, last] == [stretch[0], stretch[-1]]
            assert size(first, last) >= config.shortest * horizon - 1e-9
        else:
            assert size(first, last - 1) < horizon + 1e-9
        row = np.flatnonzero(run.odometry.stamps_s <= begin_s)[-1]
        assert windows.terrain[k] == run.odometry["terrain"][row]


@given(run=runs(), config=configs)
def test_no_stretch_that_could_be_a_window_is_lost(run, config):
    horizon = config.horizon_s or config.travel_m
    windows = windows_or_skip([run], config)
    for stretch in stretches_of(run):
        begin_s, end_s = run.pose.stamps_s[[stretch[0], stretch[-1]]]
        length = end_s - begin_s if config.horizon_s else travel_between(run, begin_s, end_s)
        count = np.sum((windows.start_s >= begin_s) & (windows.start_s < end_s))
        if length >= config.shortest * horizon + 1e-9:
            assert count >= 1
        elif length < config.shortest * horizon - 1e-9:
            assert count == 0


@given(run=runs(), config=configs, seed=st.integers(0, 2**32))
def test_where_keeps_what_the_windows_measure_and_predict(run, config, seed):
    windows = windows_or_skip([run], config)
    chosen = np.random.default_rng(seed).random(len(windows)) < 0.5
    assume(chosen.any())
    kept = windows.where(chosen)
    assert len(kept) == chosen.sum()
    for name in ("first_pose", "last_pose", "measured", "travel_m", "start_s", "run", "terrain"):
        np.testing.assert_array_equal(getattr(kept, name), getattr(windows, name)[chosen])
    for predict in (window_motion, derivative_of_motion):
        np.testing.assert_allclose(
            predict(Icr(), VALUES, kept),
            predict(Icr(), VALUES, windows)[chosen],
            rtol=1e-9,
            atol=1e-10,
        )


def test_where_carries_no_samples_that_no_window_needs(winding):
    windows = windows_of([winding], WindowConfig())
    chosen = np.zeros(len(windows), dtype=bool)
    chosen[[3, 4, 11]] = True
    needed = set()
    for k in np.flatnonzero(chosen):
        needed |= set(range(windows.first[k], windows.last[k] + 1))
    assert len(windows.where(chosen).steps_s) == len(needed)
    assert len(windows.where(np.zeros_like(chosen))) == 0


@given(first=runs("first"), second=runs("second"), config=configs)
def test_several_runs_are_their_windows_end_to_end(first, second, config):
    """Neither shares a pose with the other."""
    one, two = windows_or_skip([first], config), windows_or_skip([second], config)
    both = windows_of([first, second], config)
    for name in ("measured", "travel_m", "start_s", "run", "terrain"):
        np.testing.assert_array_equal(
            getattr(both, name), np.concatenate([getattr(one, name), getattr(two, name)])
        )
    assert set(both.run) == {"first", "second"}
    for predict in (window_motion, derivative_of_motion):
        apart = [predict(Icr(), VALUES, windows) for windows in (one, two)]
        np.testing.assert_allclose(
            predict(Icr(), VALUES, both), np.concatenate(apart), rtol=1e-9, atol=1e-10
        )
    poses = [{*both.first_pose[here], *both.last_pose[here]} for here in (both.run == "first",)]
    others = {*both.first_pose[both.run == "second"], *both.last_pose[both.run == "second"]}
    assert not poses[0] & others
