"""How late positions without yaw are, against the delay that was put in."""

from dataclasses import replace

import numpy as np
import pytest

from odometry.geometry.angles import wrap
from odometry.positions.heading import found_heading
from odometry.positions.lateness import positions_late_s
from odometry.windows.config import WindowConfig
from odometry.windows.stretches import position_record_with_yaw_rates
from tests.odometry.positions_drives import drive, emptied, table


def moved_in_time(of, late_s):
    return table({**of.columns, "t": of.stamps_s + late_s})


def late_s_of(run):
    return positions_late_s(position_record_with_yaw_rates(emptied(run), WindowConfig()))


@pytest.mark.parametrize("late_s", [0.37, -0.22])
def test_late_positions_are_as_late_as_they_were_made(late_s):
    run = drive(5, noise_m=0.02, gyroscope=True)
    run = replace(run, pose=moved_in_time(run.pose, late_s))
    assert late_s_of(run) == pytest.approx(late_s, abs=0.02)


def test_positions_in_time_and_late_treads_alone_are_not_late():
    run = drive(5, noise_m=0.02, gyroscope=True)
    assert late_s_of(run) == 0.0
    assert late_s_of(replace(run, odometry=moved_in_time(run.odometry, -0.3))) == 0.0


def test_without_a_gyroscope_nothing_is_said():
    run = drive(5, noise_m=0.02)
    assert late_s_of(replace(run, pose=moved_in_time(run.pose, 0.37))) == 0.0


def test_the_yaw_of_late_positions_is_that_at_which_they_were_measured():
    run = drive(5, noise_m=0.02, gyroscope=True)
    late = replace(run, pose=moved_in_time(run.pose, 0.4))
    found = found_heading(emptied(late))
    off_rad = wrap(found.run.pose["yaw"] - run.pose["yaw"])
    assert np.sqrt(np.nanmean(off_rad**2)) < np.radians(2.0)
    assert np.array_equal(found.run.pose.stamps_s, late.pose.stamps_s)
    assert "late beside the gyroscope" in found.words
