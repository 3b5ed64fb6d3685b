"""Rows that are all in the file, rows whose stamps were repeated, and stamps of another rate."""

from dataclasses import replace

import numpy as np

from odometry.checks.evidence.evidence import Evidence
from odometry.checks.findings.consequences import without_consequences
from odometry.checks.findings.finding import Finding, Level
from odometry.checks.findings.undo import TREADS
from odometry.checks.recording import check_recording
from odometry.checks.treads.tread_motion import _cause
from tests.odometry.checks.answers import warnings
from tests.odometry.checks.drives import PERIOD_S, stepping, table, winding
from tests.odometry.checks.faulty import put, without_gyroscope

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
    assert warnings(replace(run, pose=pose)) != []
    read = replace(run.pose, columns={**run.pose.columns, "t": t}).without_repeated()
    assert read.stamps_s.tolist() == pose.stamps_s.tolist()
    assert warnings(replace(run, pose=read)) == ["repeated_stamps"]


def test_stamps_of_another_rate_are_no_other_recording():
    run = winding()
    slow = table("imu.csv", t=3.0 * AT_S[:2400], gyro_z=run.odometry["gyro_z"])
    found = check_recording(replace(run, imu=slow)).at(Level.WARNING)[0]
    assert found.name == "files_apart"
    assert "stamps were made up" in found.cause


def test_rows_that_are_lost_between_bursts_are_a_gap():
    """Each second they come 1 ms apart, but for six seconds."""
    run = winding()
    t = np.ceil(AT_S[:2400] + 0.01) + 0.001 * (np.arange(2400) % 20)
    imu = table("imu.csv", t=AT_S[:2400], gyro_z=run.odometry["gyro_z"])
    bursts = table("odometry.csv", **{**run.odometry.columns, "t": t})
    bursts = bursts.rows(np.flatnonzero((t < 40) | (t > 45)))
    found = check_recording(replace(run, odometry=bursts, imu=imu)).findings
    assert [finding.name for finding in found] == ["uneven_stamps", "odometry_gap"]
    assert "no rows for 5.1 s" in found[1].seen


def finding(name):
    return Finding(name, Level.WARNING, "", "", "")


def test_what_is_wrong_with_stamps_or_axes_hides_what_follows():
    """Rows of two clocks come in pairs; treads that do not go with turns have no known unit."""
    for cause, follows in (
        ("interleaved_rows", "uneven_stamps"),
        ("gyroscope_unrelated", "tread_unit"),
    ):
        assert without_consequences([finding(cause), finding(follows)]) == [finding(cause)]


def test_yaw_may_be_wrong_where_no_gyroscope_says_that_the_robot_turns():
    run = winding(4000)
    zero = {n: np.where((AT_S > 40) & (AT_S < 60), 0.0, run.odometry[n]) for n in TREADS}
    stopped, span = put(run, "odometry", **zero), [np.array([41.0, 59.0])]
    assert "the yaw is wrong there" not in _cause(Evidence(stopped), span)
    assert "the yaw is wrong there" in _cause(Evidence(without_gyroscope(stopped)), span)


def test_speeds_held_where_rows_are_missing_repeat_no_value():
    run = winding(4000)
    lost = replace(run, odometry=run.odometry.rows(np.flatnonzero((AT_S < 60) | (AT_S > 70))))
    cause = _cause(Evidence(lost), [np.array([60.0, 70.0])])
    assert cause.startswith("Either rows of odometry.csv are lost")
