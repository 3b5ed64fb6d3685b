"""Merging by hand-written folders; poses are placed by their stamps, so that x shows which."""

import numpy as np
import pytest

from odometry.errors import WindowError
from odometry.recording.run import UNKNOWN, Run
from odometry.windows.config import WindowConfig
from odometry.windows.recorded.measured_poses import close_pairs
from odometry.windows.recorded.record import UNKNOWN_TURNS, record_of
from odometry.windows.recorded.run_inputs import inputs_of

CONFIG = WindowConfig(pose_gap_s=0.5)
SLOW = 2.0**-10  # [m/s]: turns too slow for their count to be in doubt
SETTINGS = "[robot]\ntrack_width = 0.4\n"


def odometry(stamps_s, **columns):
    """v_left counts the rows from 1 in SLOW, v_right is its negative."""
    names = ["t", "v_left", "v_right", *columns]
    rows = enumerate(zip(stamps_s, *columns.values(), strict=True), start=1)
    lines = [",".join(map(str, (row[0], SLOW * i, -SLOW * i, *row[1:]))) for i, row in rows]
    return "\n".join([",".join(names), *lines]) + "\n"


def pose(stamps_s, window=None):
    """x is the stamp."""
    if window is None:
        return "t,x,y,yaw\n" + "".join(f"{t},{t},0,0\n" for t in stamps_s)
    rows = zip(stamps_s, window, strict=True)
    return "t,x,y,yaw,window\n" + "".join(f"{t},{t},0,0,{w}\n" for t, w in rows)


@pytest.fixture
def record(make_run):
    def make(odometry_csv, pose_csv, settings=SETTINGS):
        folder = make_run(settings=settings, odometry=odometry_csv, pose=pose_csv)
        return record_of(Run.read(folder), CONFIG)

    return make


def groups(record):
    """Stamps of the poses of each stretch."""
    return [
        record.poses[record.stretch == number, 0].tolist() for number in np.unique(record.stretch)
    ]


def test_stamps_are_merged_and_the_row_in_force_is_the_last_before(record):
    """A pose at a stamp of odometry is no sample of its own."""
    merged = record(odometry([0.0, 0.2, 0.4, 0.6]), pose([0.1, 0.2, 0.35]))
    assert merged.stamps_s.tolist() == [0.0, 0.1, 0.2, 0.35, 0.4, 0.6]
    assert (merged.inputs.left / SLOW).tolist() == [1, 1, 2, 2, 3, 4]
    assert (merged.inputs.right / SLOW).tolist() == [-1, -1, -2, -2, -3, -4]
    assert merged.stamps_s[merged.pose_samples].tolist() == [0.1, 0.2, 0.35]
    np.testing.assert_allclose(merged.travel_m / SLOW, [0, 0.1, 0.2, 0.5, 0.6, 1.2], rtol=1e-14)
    assert merged.stretch.tolist() == [0, 0, 0]


def test_run_time_is_that_of_every_sample(record):
    """Since the first stamp of odometry, at poses between its rows too."""
    merged = record(odometry([5.0, 5.2, 5.4]), pose([5.1, 5.35]))
    np.testing.assert_allclose(merged.inputs.time_s, [0.0, 0.1, 0.2, 0.35, 0.4], atol=1e-12)


def test_attitude_and_accelerations_hold_like_the_speeds(record):
    csv = odometry(
        [0.0, 0.2, 0.4],
        roll=[0.1, "", 0.3],
        pitch=["", 0.2, ""],
        accel_x=[1, 2, 3],
        accel_y=[4, 5, 6],
    )
    inputs = record(csv, pose([0.1, 0.3])).inputs
    np.testing.assert_allclose(inputs.roll_rad, [0.1, 0.1, 0.2, 0.2, 0.3], rtol=1e-14)
    np.testing.assert_allclose(inputs.pitch_rad, [0.2] * 5, rtol=1e-14)
    np.testing.assert_array_equal(
        inputs.accelerations_m_s2, [[1, 4], [1, 4], [2, 5], [2, 5], [3, 6]]
    )


def test_a_pause_of_the_poses_breaks_a_stretch(record):
    stamps_s = np.round(np.arange(0, 4, 0.1), 1)
    often = [0.1, 0.2, 0.3, 0.4, 0.5, 0.6, 0.7]
    cut = record(odometry(stamps_s), pose([*often, 1.2, 1.825, 2.2, 3.2]))
    assert groups(cut) == [[*often, 1.2], [1.825, 2.2], [3.2]]


def test_poses_that_are_always_seconds_apart_have_no_pause(record):
    stamps_s = np.round(np.arange(0, 14, 0.1), 1)
    seldom = [1.0, 3.0, 5.0, 7.0]
    assert groups(record(odometry(stamps_s), pose(seldom))) == [seldom]
    assert groups(record(odometry(stamps_s), pose([0.5, 1.0, 1.5, 2.0, 4.6]))) == [
        [0.5, 1.0, 1.5, 2.0],
        [4.6],
    ]


@pytest.mark.parametrize(
    ("pose_s", "expected"),
    [
        ([0.15, 0.3, 1.5, 1.55], [[0.15, 0.3], [1.5, 1.55]]),
        ([0.15, 0.35, 1.4, 1.55], [[0.15], [0.35], [1.4], [1.55]]),
        ([0.15, 0.25, 0.45, 1.5], [[0.15, 0.25], [0.45], [1.5]]),
        ([0.15, 0.3, 0.45, 1.5], [[0.15, 0.3], [0.45], [1.5]]),
        ([0.1, 0.3], [[0.1, 0.3]]),
        ([1.5, 1.7], [[1.5, 1.7]]),
    ],
    ids=["at both edges", "two inside", "one inside", "edge and inside", "before", "after"],
)
def test_a_gap_of_the_odometry_breaks_a_stretch(make_run, pose_s, expected):
    """0.01 s apart, but from 0.3 to 1.5 nothing: no two poses across it, or in it, are one."""
    stamps_s = np.round(np.r_[np.arange(0, 0.301, 0.01), np.arange(1.5, 1.8, 0.01)], 2)
    run = Run.read(make_run(odometry=odometry(stamps_s), pose=pose(pose_s)))
    assert groups(record_of(run, WindowConfig(pose_gap_s=10.0))) == expected


def test_a_hold_that_nothing_contradicts_breaks_nothing(record):
    """Forty periods, but less than a second."""
    stamps_s = np.round(np.r_[np.arange(0, 0.301, 0.01), np.arange(0.7, 1, 0.01)], 2)
    standing = "t,x,y,yaw\n" + "".join(f"{t},0,0,0\n" for t in (0.15, 0.35, 0.65, 0.75))
    assert set(record(odometry(stamps_s), standing).breaks) == {""}


def test_poses_between_which_turns_cannot_be_counted_break_a_stretch(make_run):
    """2.5 m/s apart on 0.4 m are up to two turns a second; after 1 s the count is open."""
    csv = "t,v_left,v_right\n" + "".join(f"{i / 10},-0.5,0.5\n" for i in range(40))
    run = Run.read(make_run(settings=SETTINGS, odometry=csv, pose=pose([0.1, 0.3, 0.5, 1.5, 1.7])))
    found = record_of(run, WindowConfig(pose_gap_s=10.0))
    assert groups(found) == [[0.1, 0.3, 0.5], [1.5, 1.7]]
    assert found.breaks.tolist() == ["", "", UNKNOWN_TURNS, ""]


def test_a_change_of_window_breaks_a_stretch(record):
    stamps_s = np.round(np.arange(0, 2, 0.1), 1)
    cut = record(
        odometry(stamps_s), pose([0.1, 0.2, 0.3, 0.4, 0.5, 0.6], window=[7, 7, 3, 3, 7, 7])
    )
    assert groups(cut) == [[0.1, 0.2], [0.3, 0.4], [0.5, 0.6]]


def test_a_change_of_terrain_breaks_a_stretch_at_the_odometry_row_that_names_it(record):
    """grass from 0.3 on: a pose at 0.3 itself stands on grass, with the row in force there."""
    stamps_s = np.round(np.arange(0, 0.9, 0.1), 1)
    names = ["ice"] * 3 + ["grass"] * 3 + [""] * 3
    cut = record(
        odometry(stamps_s, terrain=names),
        pose([0.05, 0.25, 0.3, 0.55, 0.65, 0.75]),
        SETTINGS + '[run]\nterrain = "sand"\n',
    )
    assert groups(cut) == [[0.05, 0.25], [0.3, 0.55], [0.65, 0.75]]
    assert cut.terrains.tolist() == ["ice", "ice", "grass", "grass", "sand", "sand"]


def test_other_terrain_between_two_poses_breaks_a_stretch(record):
    stamps_s = np.round(np.arange(0, 0.9, 0.1), 1)
    names = ["ice"] * 3 + ["grass"] + ["ice"] * 5
    cut = record(odometry(stamps_s, terrain=names), pose([0.05, 0.25, 0.45, 0.65]))
    assert groups(cut) == [[0.05, 0.25], [0.45, 0.65]]


@pytest.mark.parametrize(
    ("settings", "expected"),
    [(SETTINGS, UNKNOWN), (SETTINGS + '[run]\nterrain = "sand"\n', "sand")],
    ids=["nowhere", "run.toml"],
)
def test_without_a_column_the_terrain_is_the_runs(record, settings, expected):
    assert set(record(odometry([0.0, 1.0]), pose([0.1, 0.2]), settings).terrains) == {expected}


@pytest.mark.parametrize("gone", ["{t},,0,0", "{t},{t},,0", "{t},{t},0,"])
def test_a_row_with_an_empty_cell_is_no_pose(record, gone):
    """And where the next one is too late, the stretch breaks there."""
    stamps_s = np.round(np.arange(0, 2, 0.1), 1)
    lines = pose([0.1, 0.4, 0.7, 0.8, 0.9, 1.0]).splitlines()
    lines[2] = gone.format(t=0.4)
    cut = record(odometry(stamps_s), "\n".join(lines) + "\n")
    assert groups(cut) == [[0.1], [0.7, 0.8, 0.9, 1.0]]


def test_poses_outside_the_time_of_odometry_are_left_out(record):
    stamps_s = np.round(np.arange(0, 1.01, 0.1), 1)
    kept = record(odometry(stamps_s), pose([-0.1, 0.0, 0.3, 0.6, 1.0, 1.05]))
    assert kept.poses[:, 0].tolist() == [0.0, 0.3, 0.6, 1.0]
    assert kept.stamps_s[[0, -1]].tolist() == [0.0, 1.0]


@pytest.mark.parametrize(
    ("pose_csv", "count"),
    [
        (None, 0),
        (pose([0.1]), 1),
        (pose([-2, -1, 5, 6]), 0),
        ("t,x,y,yaw\n0.1,,0,0\n0.2,0,0,0\n", 1),
    ],
    ids=["no file", "one row", "at another time", "empty cells"],
)
def test_fewer_than_two_poses_name_folder_and_count(make_run, pose_csv, count):
    folder = make_run(odometry=odometry([0.0, 0.1, 0.2]), pose=pose_csv)
    with pytest.raises(WindowError, match=rf"a_run: {count} measured poses .*pose\.csv"):
        record_of(Run.read(folder), CONFIG)


def test_one_row_of_odometry_is_too_few(make_run):
    folder = make_run(odometry=odometry([0.0]), pose=pose([0.0, 0.1]))
    with pytest.raises(WindowError, match="1 measured poses"):
        record_of(Run.read(folder), CONFIG)


def test_turns_are_counted_once_and_headings_are_those_of_the_run(make_run, monkeypatch):
    """Between the poses of a robot that turns by 0.1 rad/s."""
    stamps_s = np.arange(0.0, 100.0, 0.25)
    yaw = (0.1 * stamps_s + 3.0 + np.pi) % (2 * np.pi) - np.pi
    rows = "".join(f"{t},0,0,{a}\n" for t, a in zip(stamps_s[1::2], yaw[1::2], strict=True))
    treads = "".join(f"{t},-0.02,0.02\n" for t in stamps_s)
    folder = make_run(
        settings=SETTINGS, odometry=f"t,v_left,v_right\n{treads}", pose=f"t,x,y,yaw\n{rows}"
    )
    run, counts = Run.read(folder), []
    found = inputs_of(run).heading_rad
    monkeypatch.setattr(
        "odometry.windows.recorded.turns.close_pairs",
        lambda *of: counts.append(1) or close_pairs(*of),
    )
    record = record_of(run, CONFIG)
    assert len(counts) == 1
    inside = stamps_s[1:-1]
    np.testing.assert_allclose(record.inputs.heading_rad[1:-1], 0.1 * inside + 3.0, atol=1e-9)
    np.testing.assert_allclose(found[1:-1], 0.1 * inside + 3.0, atol=1e-9)
