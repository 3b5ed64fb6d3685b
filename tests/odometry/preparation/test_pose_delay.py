"""Poses whose stamps are late: moved where it is certain, left alone where it is not."""

from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

from odometry.estimation.config import IcrEkfConfig
from odometry.preparation.pose_delay import without_pose_delay
from odometry.recording.run import Robot, Run
from odometry.tables.table import Table
from tests.odometry.checks.drives import PERIOD_S, driven, starts_and_stops
from tests.odometry.checks.faulty import late, put, treads, without_gyroscope
from tests.odometry.estimation.sensor_drives import WIDTH, drive


def table(name, **columns):
    return Table(Path(name), columns, np.arange(len(columns["t"])) + 2)


def run_of(late_s, *, with_gyroscope=True):
    """Two minutes of turning, stamps of the poses so many seconds late."""
    driven = drive(120.0)
    t, (left, right) = driven.stamps_s, driven.speeds_m_s.T
    columns = {"t": t, "v_left": left, "v_right": right}
    if with_gyroscope:
        columns["gyro_z"] = np.append(driven.yaw_rates_rad_s[1:], driven.yaw_rates_rad_s[-1])
    x, y, yaw = driven.poses.T
    noise = np.random.default_rng(1).normal(0, 0.003, len(t))
    pose = table("pose.csv", t=t + late_s, x=x, y=y, yaw=yaw + noise)
    return Run(Path("run"), Robot(WIDTH), {}, table("odometry.csv", **columns), pose)


@pytest.mark.parametrize("late_s", [0.1, 0.3, 0.6])
def test_a_delay_is_found_and_undone(late_s):
    run, (event,) = without_pose_delay(run_of(late_s), IcrEkfConfig())
    assert event.kind == "late_poses"
    assert event.values[0] == pytest.approx(late_s, abs=0.06)
    np.testing.assert_allclose(run.pose.stamps_s, run_of(0.0).pose.stamps_s, atol=0.06)


@pytest.mark.parametrize("late_s", [-0.4, -0.1, 0.0, 0.03])
def test_what_is_not_certain_is_left_alone(late_s):
    """Early poses have another cause, and very short delays cannot be estimated."""
    given = run_of(late_s)
    run, events = without_pose_delay(given, IcrEkfConfig())
    assert run is given
    assert events == ()


def turned(run, name):
    return np.unwrap(run.pose[name]) if name == "yaw" else run.pose[name]


@pytest.mark.parametrize(("names", "late_s"), [(("yaw",), 0.5), (("x", "y"), 0.7)])
def test_of_two_times_the_part_that_is_late_is_moved(names, late_s):
    """All of the poses, moved by the delay of their yaw, would have positions that are early."""
    on_time = driven()
    run, (event,) = without_pose_delay(late(on_time, names, late_s), IcrEkfConfig())
    assert event.kind == "late_poses"
    for name, within in (("x", 0.12), ("y", 0.12), ("yaw", 0.1)):
        truth = np.interp(run.pose["t"], on_time.pose["t"], turned(on_time, name))
        off = run.pose[name] - truth
        off = np.angle(np.exp(1j * off)) if name == "yaw" else off
        inside = np.isfinite(off) & (run.pose["t"] > 2) & (run.pose["t"] < 195)
        assert inside.sum() > 1500
        assert np.abs(off[inside]).max() < within


def test_where_positions_contradict_a_late_yaw_and_nothing_decides_nothing_is_moved():
    """The robot follows its treads late as well, so that yaw alone is not named."""
    t = driven().odometry["t"]
    early = treads(driven(), lambda *both: tuple(np.interp(t + 0.3, t, of) for of in both))
    given = late(early, ("yaw",), 0.5)
    assert without_pose_delay(given, IcrEkfConfig()) == (given, ())


def test_a_gyroscope_that_is_early_leaves_poses_alone():
    """Poses and treads agree; against the gyroscope both are late."""
    run = run_of(0.0)
    t, rates = run.odometry.stamps_s, run.odometry["gyro_z"]
    columns = {**run.odometry.columns, "gyro_z": np.interp(t + 0.1, t, rates)}
    given = replace(run, odometry=table("odometry.csv", **columns))
    assert without_pose_delay(given, IcrEkfConfig()) == (given, ())


def test_without_a_gyroscope_late_poses_cannot_be_distinguished_from_early_treads():
    given = run_of(0.5, with_gyroscope=False)
    assert without_pose_delay(given, IcrEkfConfig()) == (given, ())


@pytest.mark.parametrize("settings", [{"watch_sensors": False}, {"causal": True}])
def test_nobody_searches_for_it_where_nobody_watches_or_only_the_past_counts(settings):
    given = run_of(0.5)
    assert without_pose_delay(given, IcrEkfConfig(**settings)) == (given, ())


def test_a_delay_that_is_given_is_taken():
    given = run_of(0.1)
    run, (event,) = without_pose_delay(given, IcrEkfConfig(pose_delay_s=0.1))
    np.testing.assert_allclose(run.pose.stamps_s, given.pose.stamps_s - 0.1)
    assert "as given" in event.text
    alone = replace(given, pose=None)
    assert without_pose_delay(alone, IcrEkfConfig(pose_delay_s=0.1)) == (alone, ())


@pytest.mark.parametrize(("late_s", "is_undone"), [(0.0, False), (0.1, True), (0.8, True)])
def test_a_delay_of_positions_is_undone_by_their_path(late_s, is_undone):
    run = starts_and_stops(late_s + PERIOD_S, 5.0, 0.02)  # its positions are a period early
    assert without_pose_delay(without_gyroscope(run), IcrEkfConfig())[1] == ()
    _, events = without_pose_delay(run, IcrEkfConfig())
    assert [event.kind for event in events] == ["late_poses"] * is_undone
    assert [event.values[0] for event in events] == pytest.approx([late_s] * is_undone, abs=0.03)


def test_a_short_delay_beside_a_gyroscope_that_is_late_itself_stays():
    run = starts_and_stops(0.3, 5.0, 0.02)
    late_gyroscope = put(run, "odometry", gyro_z=np.roll(run.odometry["gyro_z"], 6))
    assert without_pose_delay(late_gyroscope, IcrEkfConfig())[1] == ()


def stepping(late):
    """A latency of 0.4 s more from half way on, of the poses or of the gyroscope."""
    run = run_of(0.0)
    more_s = 0.4 * (run.pose.stamps_s > 60.0)
    if late == "pose":
        return put(run, "pose", t=run.pose.stamps_s + more_s)
    stamps_s = run.odometry.stamps_s
    measured = np.interp(stamps_s - more_s, stamps_s, run.odometry["gyro_z"])
    return put(run, "odometry", gyro_z=measured)


def test_a_latency_of_poses_that_steps_is_undone():
    run, (event,) = without_pose_delay(stepping("pose"), IcrEkfConfig())
    assert event.kind == "late_poses"
    on_time_s = run_of(0.0).pose.stamps_s
    x = np.interp(on_time_s, run.pose.stamps_s, run.pose["x"])
    assert np.median(np.abs(x - run_of(0.0).pose["x"])) < 0.02


@pytest.mark.parametrize("late", ["pose", "gyroscope"])
def test_where_treads_do_not_turn_nothing_says_whose_latency_steps(late):
    given = stepping(late)
    mean = (given.odometry["v_left"] + given.odometry["v_right"]) / 2
    given = put(given, "odometry", v_left=mean, v_right=mean)
    run, events = without_pose_delay(given, IcrEkfConfig())
    assert run is given
    assert events == ()
