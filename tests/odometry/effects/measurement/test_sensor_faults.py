"""Faults of the gyroscope and of the reference."""

import numpy as np
import pytest

from odometry.effects.measurement.gyroscope_error import GyroscopeBySpeedError, GyroscopeError
from odometry.effects.measurement.reference_fault import Compass
from odometry.models.inputs import Inputs
from tests.odometry.effects.reports import reported


def test_a_gyroscope_is_scaled_and_drifts():
    inputs = Inputs(np.zeros((3, 2)), time_s=np.array([0.0, 10.0, 20.0]))
    rates = np.array([1.0, 0.0, -2.0])
    found = GyroscopeError().gyroscope(np.array([1.1, 1e-3]), rates, inputs)
    np.testing.assert_allclose(found, [1.1, 0.01, -2.18], atol=1e-15)
    assert GyroscopeError().lacks(inputs, None) == "a gyroscope"


def test_a_gyroscope_shakes_with_the_speed_and_with_the_turn():
    inputs = Inputs(np.array([[0.0, 0.0], [-1.0, -1.0], [-0.5, 0.5], [0.5, 1.5]]))
    found = GyroscopeBySpeedError().gyroscope(np.array([0.01, 0.1, 0.4]), np.ones(4), inputs)
    np.testing.assert_allclose(found, [1.0, 1.11, 1.1, 1.21], atol=1e-15)
    assert GyroscopeBySpeedError().lacks(inputs, None) == "a gyroscope"


def test_what_shakes_the_gyroscope_of_a_slow_robot_is_searched():
    """0.25 rad/s at a top speed of 0.6 m/s."""
    linear, square, _ = GyroscopeBySpeedError().parameters
    assert linear.low < -0.25 / 0.6 < 0.25 / 0.6 < linear.high
    assert square.low < -0.25 / 0.6**2 < 0.25 / 0.6**2 < square.high


@pytest.mark.parametrize("bent", [(0.1, 0.0), (0.0, -0.3), (0.6, 0.6)])
def test_a_compass_is_bent_by_one_wave_a_turn_and_back(rng, bent):
    poses = rng.uniform(-9, 9, (30, 3))
    a, b = bent
    seen = poses.copy()
    seen[:, 2] += a * np.cos(poses[:, 2]) + b * np.sin(poses[:, 2])
    effect, values = Compass(), np.array(bent)
    np.testing.assert_allclose(effect.seen(values, poses, reported(seen)), seen, atol=1e-3)
    np.testing.assert_allclose(effect.robot_poses(values, reported(seen)), poses, atol=1e-3)


def test_a_drive_that_began_at_the_origin_is_bent_by_its_true_heading():
    """Simulated yaw is off by 1 rad; the error is that of the heading that was measured."""
    true_yaw = np.linspace(0, 6, 7)
    measured = true_yaw + 0.2 * np.sin(true_yaw)
    simulated = np.column_stack([np.zeros((7, 2)), true_yaw - 1.0])
    on_map = np.column_stack([np.zeros((7, 2)), measured])
    found = Compass().seen(np.array([0.0, 0.2]), simulated, reported(on_map))
    np.testing.assert_allclose(found[:, 2] - simulated[:, 2], 0.2 * np.sin(true_yaw), atol=1e-9)


@pytest.mark.parametrize(
    ("headings", "lacking"),
    [
        (np.linspace(-3.0, 3.0, 200), ""),
        (np.linspace(0.1, 12.0, 200), ""),
        (1.0 + 0.3 * np.sin(np.arange(200)), "headings over half a turn"),
        (np.repeat([0.1, 3.3], 100), "headings over half a turn"),
        (None, "headings"),
    ],
)
def test_a_compass_needs_headings_all_round(headings, lacking):
    inputs = Inputs(np.zeros((200, 2)), heading_rad=headings)
    assert Compass().lacks(inputs, None) == lacking
