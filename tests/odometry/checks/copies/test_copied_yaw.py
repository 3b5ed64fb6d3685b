"""Yaw and a gyroscope of which one was computed from the other, and yaw from the treads."""

from dataclasses import replace

import numpy as np
import pytest

from odometry import check_recording
from odometry.checks.findings.finding import Level
from tests.odometry.checks.drives import table, winding
from tests.odometry.checks.faulty import gyroscope, put


def integrated(run, rate):
    """Yaw that adds up a turn rate (N,), at the stamps of the poses."""
    t = run.odometry.stamps_s
    yaw = np.concatenate([[0.0], np.cumsum(rate[:-1] * np.diff(t))])
    return put(run, "pose", yaw=np.interp(run.pose.stamps_s, t, yaw))


def findings(run):
    return check_recording(run).findings


@pytest.mark.parametrize("digits", [3, 9])
def test_yaw_that_integrates_the_gyroscope_is_a_note(digits):
    run = winding()
    (finding,) = findings(integrated(run, np.round(run.odometry["gyro_z"], digits)))
    assert (finding.name, finding.level) == ("yaw_is_gyroscope", Level.NOTE)
    assert "leave it empty" in finding.remedy


@pytest.mark.parametrize("width_m", [0.6, 1.3], ids=["track width", "tuned"])
def test_yaw_of_wheel_odometry_beside_measured_positions(width_m):
    run = winding()
    rate = (run.odometry["v_right"] - run.odometry["v_left"]) / width_m
    (finding,) = findings(integrated(run, rate))
    assert finding.name == "yaw_is_treads"
    assert f"/ {width_m} m" in finding.seen


@pytest.mark.parametrize("central", [True, False])
def test_a_derivative_of_yaw_is_no_gyroscope(central):
    run = winding()
    t, yaw = run.pose.stamps_s, np.unwrap(run.pose["yaw"])
    forwards = np.append(np.diff(yaw) / np.diff(t), 0.0)
    rate = np.gradient(yaw, t) if central else forwards
    found = findings(gyroscope(run, lambda _: np.interp(run.odometry.stamps_s, t, rate)))
    assert found[0].name == "gyroscope_is_yaw"
    assert "derivative" in found[0].cause


def test_measured_yaw_is_no_copy():
    assert findings(winding()) == ()


def test_at_one_rate_either_may_be_the_copy():
    run = winding()
    t, yaw = run.pose.stamps_s, np.unwrap(run.pose["yaw"])
    rows = np.searchsorted(run.odometry.stamps_s, t)
    rate = np.append(np.diff(yaw) / np.diff(t), 0.0)
    slow = {n: c[rows] for n, c in run.odometry.columns.items()} | {"gyro_z": rate}
    (finding,) = findings(replace(run, odometry=table("odometry.csv", **slow)))
    assert finding.name == "yaw_is_gyroscope"
    assert "cannot be distinguished" in finding.cause
