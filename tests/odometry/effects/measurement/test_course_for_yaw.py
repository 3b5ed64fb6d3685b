"""A yaw that is the course of a point ahead: an angle in turns, none on straights or when slow."""

import numpy as np
import pytest

from odometry.effects.interface.recorded import Reported
from odometry.effects.measurement.course_for_yaw import CourseForYaw

AHEAD_M, SPEED_M_S = 0.3, 0.6
STAMPS_S = np.arange(0.0, 20.0, 0.05)


def circle(rate, speed):
    """Poses on a circle, forward or backward."""
    yaw = rate * STAMPS_S
    place = speed / (1j * rate) * (np.exp(1j * yaw) - 1)
    return np.column_stack([place.real, place.imag, yaw])


@pytest.mark.parametrize("speed", [SPEED_M_S, -SPEED_M_S])
def test_it_is_the_direction_in_which_the_point_ahead_moves(speed):
    """Of a point ahead, differences of its places give the course; backward, its opposite."""
    poses = circle(0.5, speed)
    found = CourseForYaw().seen(np.array([AHEAD_M, 0.2]), poses, Reported(STAMPS_S, poses))
    ahead = poses[:, 0] + 1j * poses[:, 1] + AHEAD_M * np.exp(1j * poses[:, 2])
    course = np.gradient(ahead, STAMPS_S) * np.sign(speed) * np.exp(-1j * found[:, 2])
    np.testing.assert_allclose(np.angle(course)[5:-5], 0.0, atol=2e-3)
    np.testing.assert_array_equal(found[:, :2], poses[:, :2])


def test_a_robot_that_is_slow_or_goes_straight_has_its_own_yaw():
    straight = np.column_stack([SPEED_M_S * STAMPS_S, 0 * STAMPS_S, 0 * STAMPS_S])
    for poses in (circle(0.5, 0.1), straight):
        found = CourseForYaw().seen(np.array([AHEAD_M, 0.2]), poses, Reported(STAMPS_S, poses))
        np.testing.assert_allclose(found, poses, atol=1e-12)


def test_without_a_gyroscope_it_is_no_candidate(bench, rng):
    assert CourseForYaw().lacks(bench.drive(rng), bench.base) == "a gyroscope"
