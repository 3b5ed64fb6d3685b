"""Columns that hold the mean of both treads where the robot turns."""

import numpy as np
import pytest

from odometry.checks.evidence.evidence import Evidence
from odometry.checks.recording import check_recording
from odometry.checks.treads.equal_in_turns import equal_in_turns
from tests.odometry.checks.drives import stepping
from tests.odometry.checks.faulty import SENSORS, later, pose_stamps, treads


def equal_where(run, odd):
    def change(left, right):
        mean = (left + right) / 2
        rows = odd(left, right)
        return np.where(rows, mean, left), np.where(rows, mean, right)

    return treads(run, change)


def sharp(left, right):
    return np.abs(right - left) > 0.3


@pytest.mark.parametrize("sensors", SENSORS)
def test_the_mean_in_sharp_turns_is_one_speed(sensors):
    run = SENSORS[sensors](equal_where(stepping(), sharp))
    found = check_recording(run).findings[0]
    assert found.name == "treads_equal"
    assert "the mean of the treads" in found.cause


@pytest.mark.parametrize("sensors", SENSORS)
def test_treads_equal_on_straight_drives_are_commands(sensors):
    """And where times are off, turns seem to be of equal treads."""
    run = equal_where(stepping(), lambda left, right: ~sharp(left, right))
    late = later(run, ("gyro_z",), 2.0), pose_stamps(run, lambda t: t + 2.0)
    for one in (run, *late):
        assert not list(equal_in_turns(Evidence(SENSORS[sensors](one))))


@pytest.mark.parametrize("sensors", SENSORS)
def test_commands_to_drive_straight_on_are_equal_where_the_robot_slides(sensors):
    """In three of ten turns of all sizes, and in all straight drives."""
    slides = np.arange(3200) % 400 < 120
    run = equal_where(stepping(), lambda left, right: slides | ~sharp(left, right))
    assert not list(equal_in_turns(Evidence(SENSORS[sensors](run))))


def test_speeds_that_are_held_are_lost_and_not_equal():
    """A log that repeats its last values repeats two numbers, or one by chance."""
    run = stepping()

    def change(left, right):
        rows = sharp(left, right)
        return np.where(rows, 0.5, left), np.where(rows, 0.5, right)

    assert not list(equal_in_turns(Evidence(treads(run, change))))


@pytest.mark.parametrize(("sensors", "side"), list(zip(SENSORS, (0, 1, 0), strict=True)))
def test_one_tread_twice_in_a_part_with_straight_drives_of_its_own(sensors, side):
    run = stepping()
    part = (run.odometry["t"] > 41.3) & (run.odometry["t"] < 93.6)

    def change(*both):
        return np.where(part, both[side], both[0]), np.where(part, both[side], both[1])

    found = check_recording(SENSORS[sensors](treads(run, change))).findings[0]
    assert found.name == "treads_equal"
    ((begin_s, end_s),) = found.spans_s
    assert (begin_s, end_s) == pytest.approx((41.3, 93.6), abs=1.5)


def test_one_tread_twice_of_a_log_that_has_a_new_value_in_one_of_six_rows():
    run = stepping()
    held = np.arange(len(run.odometry)) // 6 * 6
    part = (run.odometry["t"] > 50.0) & (run.odometry["t"] < 95.0)

    def change(left, right):
        return left[held], np.where(part, left[held], right[held])

    (found,) = equal_in_turns(Evidence(treads(run, change)))
    ((begin_s, end_s),) = found.spans_s
    assert (begin_s, end_s) == pytest.approx((50.0, 95.0), abs=1.5)
