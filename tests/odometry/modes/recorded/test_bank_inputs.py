"""What the filters are fed with, against tables written by hand."""

from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from odometry.errors import RunFolderError
from odometry.modes.identify.mode_windows import stretches_by_label
from odometry.modes.recorded.bank_inputs import forward_speed_m_s, pose_signals, velocity_signals
from odometry.recording.run import Robot, Run
from odometry.tables.table import Table

NAN = float("nan")


def table(**columns):
    columns = {name: np.asarray(column) for name, column in columns.items()}
    return Table(Path("t.csv"), columns, np.arange(len(columns["t"])) + 2)


@pytest.fixture
def run():
    t = 0.1 * np.arange(5)
    odometry = table(t=t, v_left=[1.0, 2, 3, 4, 5], v_right=[2.0, 2, 2, 2, 2], gyro_z=0.1 * t)
    return Run(Path("one"), Robot(0.5), {"run": {"terrain": "ice"}}, odometry)


def without_gyro(run, **tables):
    columns = {name: run.odometry[name] for name in ("t", "v_left", "v_right")}
    return replace(run, odometry=table(**columns), **tables)


def test_yaw_rate_of_the_gyroscope_and_no_speed(run):
    signals = velocity_signals(run)
    assert len(signals) == 5
    assert signals.measured[:, 1] == pytest.approx(0.01 * np.arange(5))
    assert np.isnan(signals.measured[:, 0]).all()
    assert signals.tread_speeds_m_s.tolist() == [[1, 2], [2, 2], [3, 2], [4, 2], [5, 2]]
    assert signals.labels.tolist() == ["ice"] * 5


def test_the_yaw_rate_of_imu_csv_goes_to_the_nearest_stamp(run):
    imu = table(t=[0.02, 0.11, 0.28, 0.6], gyro_z=[0.5, NAN, 0.7, 0.9])
    signals = velocity_signals(without_gyro(run, imu=imu))
    np.testing.assert_array_equal(signals.measured[:, 1], [0.5, NAN, NAN, 0.7, NAN])
    pose = table(t=[0.1, 0.25], x=[1.0, 2.0], y=[4.0, 5.0], yaw=[7.0, 8.0])
    merged = pose_signals(without_gyro(run, imu=imu, pose=pose))
    np.testing.assert_array_equal(merged.measured[:, 3], [0.5, NAN, NAN, NAN, 0.7, NAN])


def test_velocities_go_to_the_nearest_stamp_alone(run):
    velocity = table(t=[0.02, 0.14, 0.29, 2.0], vx=[1.0, 2.0, 3.0, 9.0], wz=[0.1, NAN, 0.3, 9.0])
    signals = velocity_signals(without_gyro(run, velocity=velocity))
    expected = [[1.0, 0.1], [2.0, NAN], [NAN, NAN], [3.0, 0.3], [NAN, NAN]]
    np.testing.assert_array_equal(signals.measured, expected)


def test_a_run_without_a_yaw_rate_is_reported(run):
    for velocity in (None, table(t=[0.0, 0.1], vx=[1.0, 1.0], wz=[NAN, NAN])):
        with pytest.raises(RunFolderError, match="one: no yaw rate; expected gyro_z in odom"):
            velocity_signals(without_gyro(run, velocity=velocity))


def test_poses_are_merged_with_odometry_whose_speeds_hold(run):
    pose = table(t=[-1.0, 0.1, 0.25, 9.0], x=[0.0, 1, 2, 3], y=[0.0, 4, 5, 6], yaw=[0.0, 7, 8, 9])
    signals = pose_signals(replace(run, pose=pose))
    assert signals.stamps_s == pytest.approx([0, 0.1, 0.2, 0.25, 0.3, 0.4])
    assert signals.tread_speeds_m_s[:, 0].tolist() == [1, 2, 3, 3, 4, 5]
    assert np.flatnonzero(np.isfinite(signals.measured[:, :3]).any(axis=1)).tolist() == [1, 3]
    assert signals.measured[[1, 3], :3].tolist() == [[1, 4, 7], [2, 5, 8]]
    assert signals.labels.tolist() == ["ice"] * 6
    yaw_rates = [0.0, 0.01, 0.02, NAN, 0.03, 0.04]
    np.testing.assert_allclose(signals.measured[:, 3], yaw_rates, atol=1e-12)


def test_a_run_without_poses_in_its_time_is_reported(run):
    with pytest.raises(RunFolderError, match=r"one: no pose\.csv"):
        pose_signals(run)
    with pytest.raises(RunFolderError, match="one: no pose lies within the time"):
        pose_signals(replace(run, pose=table(t=[5.0], x=[0.0], y=[0.0], yaw=[0.0])))


def test_positions_without_yaw_do_not_say_what_is_forward(run):
    t = np.arange(0.0, 0.5, 0.05)
    pose = table(t=t, x=t, y=t, yaw=np.full(len(t), NAN))
    assert forward_speed_m_s(replace(run, pose=pose)) is None
    with pytest.raises(RunFolderError, match="one: no pose with yaw"):
        pose_signals(replace(run, pose=pose))


def test_forward_speed_of_an_arc_is_its_chord(run):
    """Poses on a circle of radius 2 at 0.6 rad/s, backwards: -1.2 m/s but for the chord."""
    t = np.arange(0.0, 0.5, 0.05)
    yaw = 3.0 - 0.6 * t
    pose = table(t=t, x=2 * np.sin(yaw), y=-2 * np.cos(yaw), yaw=np.angle(np.exp(1j * yaw)))
    speed = forward_speed_m_s(replace(run, pose=pose))
    middle = (run.odometry.stamps_s > 0.14) & (run.odometry.stamps_s < 0.31)
    assert speed[middle] == pytest.approx(-2 * 2 * np.sin(0.6 * 0.15) / 0.3, rel=2e-3)


def test_forward_speed_is_the_measured_one_where_there_is_one(run):
    velocity = table(t=[0.0, 0.2, 0.4], vx=[1.0, NAN, 3.0])
    assert forward_speed_m_s(replace(run, velocity=velocity)) == pytest.approx([1, 1.5, 2, 2.5, 3])
    assert forward_speed_m_s(run) is None


def driving(stamps_s):
    """A run that turns, and of which nothing but the treads was recorded."""
    ones = np.ones(len(stamps_s))
    return Run(Path("one"), Robot(0.5), {}, table(t=stamps_s, v_left=ones, v_right=2 * ones))


@given(st.lists(st.tuples(st.sampled_from("ab"), st.booleans()), min_size=1, max_size=20))
def test_stretches_are_whole_even_and_of_one_label(rows):
    labels = np.array([label for label, _ in rows], dtype=object)
    steps = np.array([30.0 if gap else 1.0 for _, gap in rows])
    found = list(stretches_by_label(driving(np.cumsum(steps)), labels))
    assert np.concatenate([part for _, part in found]).tolist() == list(range(len(rows)))
    for label, part in found:
        assert set(labels[part]) == {label}


@pytest.mark.parametrize(("pause_s", "parts"), [(2.5, [4, 2]), (0.9, [6])])
def test_a_stretch_ends_at_a_gap_but_not_at_a_hold(pause_s, parts):
    stamps_s = np.array([0.0, 0.1, 0.2, 0.3, 0.3 + pause_s, 0.4 + pause_s])
    found = [len(rows) for _, rows in stretches_by_label(driving(stamps_s), np.array(["a"] * 6))]
    assert found == parts
