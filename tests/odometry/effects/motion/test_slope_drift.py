"""Drift downhill, against gravity in the robot's frame."""

import numpy as np
import pytest

from odometry.effects.interface.corrected import Added, corrected_twist
from odometry.effects.motion.slope_drift import SlopeDrift
from odometry.models.inputs import Inputs


def rotation(roll, pitch):
    """Ry(pitch) Rx(roll): axes of the robot in those of a level one of the same heading."""
    c, s = np.cos(roll), np.sin(roll)
    about_x = np.array([[1, 0, 0], [0, c, -s], [0, s, c]])
    c, s = np.cos(pitch), np.sin(pitch)
    return np.array([[c, 0, s], [0, 1, 0], [-s, 0, c]]) @ about_x


@pytest.mark.parametrize(("roll", "pitch"), [(0.2, 0.0), (-0.2, 0.1), (0.0, -0.3), (0.1, 0.25)])
def test_the_robot_drifts_where_gravity_pulls(bench, roll, pitch):
    """By the components of a unit weight along the axes of the tilted robot."""
    down = rotation(roll, pitch).T @ [0.0, 0.0, -1.0]
    speeds = np.array([[1.0, 1.0], [-0.5, 0.7]])
    inputs = Inputs(speeds, np.full(2, roll), np.full(2, pitch))
    plain = bench.base.model.twist(bench.values, inputs)
    found = corrected_twist(bench.base, [Added(SlopeDrift(), np.array([0.3, 0.5]))], inputs) - plain
    speed = np.abs(speeds).mean(axis=1)
    expected = np.stack([0.3 * speed * down[0], 0.5 * speed * down[1], 0 * speed], axis=-1)
    np.testing.assert_allclose(found, expected, atol=1e-15)


def test_a_robot_on_level_terrain_or_at_rest_does_not_drift(bench, rng):
    effect = Added(SlopeDrift(), np.array([0.3, 0.5]))
    level = Inputs(bench.drive(rng).tread_speeds_m_s)
    rest = Inputs(np.zeros((3, 2)), np.full(3, 0.2), np.full(3, 0.1))
    for inputs in (level, rest):
        plain = bench.base.model.twist(bench.values, inputs)
        np.testing.assert_array_equal(corrected_twist(bench.base, [effect], inputs), plain)
    assert "not level" in SlopeDrift().lacks(level, bench.base)
    assert SlopeDrift().lacks(bench.drive(rng), bench.base) == ""
