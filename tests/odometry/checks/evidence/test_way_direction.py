"""Headings of positions without yaw, and motion of another point of the robot."""

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from odometry.checks.evidence.evidence import Evidence
from odometry.checks.evidence.way_direction import way_direction_rad, yaw_by_gyroscope
from tests.odometry.checks.drives import PERIOD_S, drive, uneven, varied
from tests.odometry.checks.faulty import positions
from tests.odometry.checks.poses.test_far_sensor import measured_at, without_yaw

PLACES = st.floats(-2.0, 2.0)


def yaw_of(run):
    evidence = Evidence(run)
    return evidence.raw_motion, yaw_by_gyroscope(evidence.raw_motion, evidence.integrals)


@pytest.mark.parametrize("place_m", [(0.0, 0.0), (1.5, -0.4)])
def test_gyroscope_and_way_give_the_yaw_wherever_the_antenna_is(place_m):
    run = measured_at(uneven(), *place_m)
    _, yaw = yaw_of(without_yaw(run))
    at_s = Evidence(run).raw_motion
    apart = np.angle(np.exp(1j * (yaw - at_s.yaw_rad)))
    assert np.isfinite(yaw).mean() > 0.9
    assert np.nanmax(np.abs(apart)) < 0.15
    assert abs(np.nanmean(apart)) < 0.02


def test_one_circle_has_no_direction():
    """An antenna ahead or aside and another yaw are one motion there."""
    at_s = PERIOD_S * np.arange(2000)
    _, yaw = yaw_of(without_yaw(drive(np.full(len(at_s), 0.8), np.full(len(at_s), 0.4))))
    assert np.isnan(yaw).all()


@given(ahead_m=PLACES, left_m=PLACES)
def test_motion_of_another_point_is_that_of_positions_moved_there(ahead_m, left_m):
    run = uneven()
    moved = Evidence(measured_at(run, ahead_m, left_m)).raw_motion
    back = moved.of_point(moved.yaw_rad, np.array([ahead_m, left_m]))
    assert back.moved_m == pytest.approx(Evidence(run).raw_motion.moved_m, abs=1e-12)


@pytest.mark.parametrize("made", [uneven, varied])
def test_mirrored_positions_go_in_no_direction_of_the_yaw(made):
    motion = Evidence(positions(made(), lambda x, y: (x, -y))).motion
    assert np.isnan(way_direction_rad(motion, motion.yaw_rad, motion.gyroscope_rad))
