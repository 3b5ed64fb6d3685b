"""Rows that are all in the file, rows whose stamps were repeated, and stamps of another rate."""

from dataclasses import replace

import numpy as np

from odometry.checks.findings.finding import Level
from odometry.checks.recording import check_recording
from tests.odometry.checks.test_confirmed_causes import warnings
from tests.odometry.checks.test_one_delay import stepping
from tests.odometry.checks.test_other_robots import PERIOD_S, table, winding

AT_S = PERIOD_S * np.arange(4000)


def gone_back():
    """Rows of 20 s whose stamps go back by 3 s, sorted by time afterwards."""
    run = winding(4000)
    t = np.where((AT_S > 60) & (AT_S < 80), AT_S - 3.001, AT_S)
    rows = np.argsort(t)
    columns = {name: values[rows] for name, values in run.odometry.columns.items()}
    return replace(run, odometry=table("odometry.csv", **{**columns, "t": t[rows]}), pose=None)


def gap(run):
    (found,) = (f for f in check_recording(run).findings if f.name == "odometry_gap")
    return found


def test_rows_that_are_all_there_are_not_lost():
    kept = np.flatnonzero((AT_S < 77) | (AT_S > 80))
    run = winding(4000)
    lost = replace(run, odometry=run.odometry.rows(kept), pose=None)
    assert gap(lost).cause.startswith("Rows of odometry.csv are lost")
    assert gap(gone_back()).cause.startswith("Either the stamps are wrong")


def test_poses_of_whole_seconds_are_not_called_late():
    run = stepping()
    t = np.ceil(run.pose.stamps_s)
    kept = np.flatnonzero(np.diff(t, prepend=-1.0) > 0)
    pose = table("pose.csv", **{n: c[kept] for n, c in run.pose.columns.items()} | {"t": t[kept]})
    dropped = np.arange(len(t) - len(kept)) + 100
    assert warnings(replace(run, pose=pose)) != []
    assert warnings(replace(run, pose=replace(pose, repeated_lines=dropped))) == ["repeated_stamps"]


def test_stamps_of_another_rate_are_no_other_recording():
    run = winding()
    slow = table("imu.csv", t=3.0 * AT_S[:2400], gyro_z=run.odometry["gyro_z"])
    found = check_recording(replace(run, imu=slow)).at(Level.WARNING)[0]
    assert found.name == "files_apart"
    assert "stamps were made up" in found.cause


def test_rows_in_bursts_are_not_lost():
    """Each second they come 1 ms apart, while poses and gyroscope go on."""
    run = winding()
    t = np.ceil(AT_S[:2400] + 0.01) + 0.001 * (np.arange(2400) % 20)
    imu = table("imu.csv", t=AT_S[:2400], gyro_z=run.odometry["gyro_z"])
    columns = {**run.odometry.columns, "t": t}
    run = replace(run, odometry=table("odometry.csv", **columns), imu=imu)
    causes = [found.cause for found in check_recording(run).at(Level.WARNING)]
    assert causes
    assert not any(cause.startswith(("Rows of odometry.csv are", "The clock")) for cause in causes)
