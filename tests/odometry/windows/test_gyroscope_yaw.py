"""The bias of a gyroscope from positions alone, against the yaw that was driven."""

from dataclasses import replace

import numpy as np
import pytest

from odometry.windows.config import WindowConfig
from odometry.windows.gyroscope_yaw import yaw_rates_of
from odometry.windows.record import position_record_of
from tests.odometry.positions_drives import drive, emptied, table


@pytest.mark.parametrize(("seed", "noise_m"), [(0, 0.02), (1, 0.3), (2, 1.0)])
def test_the_bias_is_found_through_noise_of_the_positions(seed, noise_m):
    """Pieces of 10 m leave 0.003 rad/s under 0.3 m of noise, and 0.01 under 1 m."""
    run = drive(seed, noise_m=noise_m, gyroscope=True, bias_rad_s=0.02, duration_s=300.0)
    record = position_record_of(emptied(run), WindowConfig())
    rates = yaw_rates_of(record)
    yaw_rad = np.append(0.0, np.cumsum(rates[:-1] * np.diff(record.stamps_s)))
    turned = np.diff(yaw_rad[record.pose_samples[[0, -1]]])[0]
    driven = run.pose["yaw"][-1] - run.pose["yaw"][0]
    lasted_s = record.pose_s[-1] - record.pose_s[0]
    assert (turned - driven) / lasted_s == pytest.approx(0.0, abs=6e-4)


def test_a_run_without_gyroscope_has_no_yaw_rates():
    assert yaw_rates_of(position_record_of(emptied(drive(1)), WindowConfig())) is None


@pytest.mark.parametrize("late_s", [0.0, 0.1, -0.1])
def test_rates_that_are_means_are_taken_for_means(late_s):
    """At 5 Hz a rate at its stamp is 0.1 s beside a mean from there on, which a drive shows."""
    run = drive(3, noise_m=0.01, gyroscope=True, duration_s=200.0)
    t, rates = run.imu.stamps_s, run.imu["gyro_z"]
    every = 4
    means = rates[: len(rates) // every * every].reshape(-1, every).mean(axis=1)
    middles_s = t[::every][: len(means)] + (every - 1) / 2 * (t[1] - t[0])
    run = replace(run, imu=table({"t": middles_s - late_s, "gyro_z": means}))
    record = position_record_of(emptied(run), WindowConfig())
    yaw_rad = np.append(0.0, np.cumsum(yaw_rates_of(record)[:-1] * np.diff(record.stamps_s)))
    off_rad = yaw_rad[record.pose_samples] - run.pose["yaw"][-len(record.poses) :]
    assert np.std(off_rad[5:-5]) < 0.02
