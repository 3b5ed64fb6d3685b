"""Cells without a value: how many, and where."""

import numpy as np
import pytest

from odometry.checks.recording import check_recording
from tests.odometry.checks.drives import PERIOD_S, varied
from tests.odometry.checks.faulty import put, without_yaw


def noted(run):
    return [f for f in check_recording(run).findings if f.name == "empty_cells"]


def emptied(run, table, name, rows):
    values = getattr(run, table)[name].copy()
    values[rows] = np.nan
    return put(run, table, **{name: values})


def test_a_gyroscope_that_was_silent_is_noted_with_its_time():
    (found,) = noted(emptied(varied(), "odometry", "gyro_z", slice(1000, 1400)))
    assert "no gyro_z in 400 of 4000 rows" in found.seen
    assert found.spans_s[0] == pytest.approx((1000 * PERIOD_S, 1400 * PERIOD_S))


def test_single_rows_of_poses_are_counted():
    (found,) = noted(emptied(varied(), "pose", "x", [5, 300, 301, -1]))
    assert "pose.csv has no x in 4 of 2000 rows" in found.seen
    assert len(found.spans_s) == 3


def test_a_column_that_is_mostly_or_wholly_empty_is_not_of_this_sensor():
    run = varied()
    assert noted(run) == noted(without_yaw(run)) == []
    every_other = np.arange(len(run.odometry)) % 2 == 1
    assert noted(emptied(run, "odometry", "gyro_z", every_other)) == []
    assert noted(emptied(run, "odometry", "gyro_z", slice(None))) == []
