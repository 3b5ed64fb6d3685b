"""An inertial sensor that is mounted upside down, and what run.toml does not say of it."""

from dataclasses import replace

import numpy as np
import pytest

from odometry.tables.table import Table
from tests.odometry.checks.answers import warnings
from tests.odometry.checks.drives import uneven
from tests.odometry.checks.faulty import without_yaw


def upside_down(run):
    """Its yaw rate in imu.csv, by axes that are turned half round about x."""
    t, rate = run.odometry.stamps_s, -run.odometry["gyro_z"]
    columns = {"t": t, "gyro_z": rate, "accel_z": np.full(len(t), -9.81)}
    columns |= {axis: np.zeros(len(t)) for axis in ("accel_x", "accel_y")}
    kept = {n: c for n, c in run.odometry.columns.items() if n != "gyro_z"}
    imu = Table(run.odometry.file, columns, run.odometry.lines)
    return replace(run, imu=imu, odometry=replace(run.odometry, columns=kept))


@pytest.mark.parametrize(
    "poses", [lambda run: run, without_yaw, lambda run: replace(run, pose=None)]
)
def test_gravity_says_why_the_gyroscope_turns_against_the_treads(poses):
    """One cause, and no second finding that it cannot be determined."""
    assert warnings(poses(upside_down(uneven()))) == ["imu_mount"]
