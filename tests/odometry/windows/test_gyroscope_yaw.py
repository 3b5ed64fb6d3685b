"""The bias of a gyroscope from positions alone, against the yaw that was driven."""

import numpy as np
import pytest

from odometry.windows.config import WindowConfig
from odometry.windows.gyroscope_yaw import yaw_rates_of
from odometry.windows.record import position_record_of
from tests.odometry.positions_drives import drive, emptied


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
