"""Clocks that differ by leap seconds or by hours."""

from dataclasses import replace

import numpy as np
import pytest

from odometry.checks.evidence.evidence import Evidence
from odometry.checks.recording import check_recording
from odometry.checks.stamps.clock_offsets import clock_offsets
from odometry.tables.table import Table
from tests.odometry.checks.answers import warnings
from tests.odometry.checks.drives import drive, shunting
from tests.odometry.checks.faulty import put, without_gyroscope, without_yaw


def with_imu(run):
    columns = {name: run.odometry[name] for name in ("t", "gyro_z")}
    imu = Table(run.folder / "imu.csv", columns, run.odometry.lines)
    return replace(without_gyroscope(run), imu=imu)


def ahead(run, table, seconds):
    return put(run, table, t=getattr(run, table)["t"] + seconds)


@pytest.mark.parametrize("yaw", [True, False])
def test_clocks_that_agree_are_no_finding(yaw):
    assert warnings(with_imu(shunting() if yaw else without_yaw(shunting()))) == []


@pytest.mark.parametrize(
    ("table", "yaw", "seconds"),
    [
        *(("pose", True, 18.0), ("pose", False, -18.0), ("pose", True, 37.0)),
        *(("imu", False, 18.0), ("imu", True, -18.0), ("imu", False, 37.0)),
    ],
)
def test_leap_seconds_are_named(table, yaw, seconds):
    run = with_imu(shunting() if yaw else without_yaw(shunting()))
    (found,) = check_recording(ahead(run, table, seconds)).findings
    assert "leap seconds" in found.cause
    assert f"Add {-seconds:+.0f} s to the stamps of {table}.csv" in found.remedy


@pytest.mark.parametrize("seconds", [0.0, 7.0, 16.0, 25.0])
def test_other_offsets_have_no_known_cause(seconds):
    run = ahead(with_imu(without_yaw(shunting())), "pose", seconds)
    assert list(clock_offsets(Evidence(run))) == []


def test_a_time_zone_is_named_where_a_recording_is_as_long():
    rng = np.random.default_rng(0)
    values = np.repeat([rng.uniform(0.2, 1.0, 1000), rng.uniform(-0.4, 0.4, 1000)], 84, axis=1)
    run = without_yaw(drive(*values))
    (found,) = clock_offsets(Evidence(ahead(run, "pose", -3600.0)))
    assert "stamps of odometry.csv are 3600 s ahead" in found.cause
    assert "time zones differ by 1 hour" in found.cause


def test_a_drive_that_repeats_itself_every_18_s_says_nothing():
    at_s = 0.05 * np.arange(4000)
    speed, turn = 0.7 + 0.3 * np.sin(2 * np.pi * at_s / 18), 0.3 * np.sin(2 * np.pi * at_s / 9)
    run = without_yaw(drive(speed, turn))
    assert list(clock_offsets(Evidence(ahead(run, "pose", 9.0)))) == []
