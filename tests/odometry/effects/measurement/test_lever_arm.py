"""FACTS, "Identifiability": a lever arm looks exactly like shifted tread ICRs."""

import numpy as np
import pytest

from odometry.dead_reckoning import dead_reckon
from odometry.effects.measurement.sensor_mount import LeverArm
from odometry.models.catalogue import MODELS
from tests.odometry.effects.reports import reported

EFFECT = LeverArm()
ARM = np.array([0.3, -0.2])


def test_the_sensor_moves_as_a_robot_with_shifted_icrs(bench, rng):
    """x_icr less x_arm, both lateral ICRs less y_arm; the alphas stay."""
    inputs = bench.drive(rng)
    twists = MODELS["icr"].twist(bench.values, inputs)
    robot = dead_reckon(inputs.time_s, twists, np.array([1.0, -2.0, 0.4]))
    seen = EFFECT.seen(ARM, robot.poses, reported(robot.poses))
    shifted = bench.values - [ARM[1], ARM[1], ARM[0], 0, 0]
    alike = dead_reckon(inputs.time_s, MODELS["icr"].twist(shifted, inputs), seen[0])
    np.testing.assert_allclose(alike.poses, seen, atol=1e-12)


def test_a_point_ahead_and_to_the_left():
    seen = EFFECT.seen(
        np.array([0.5, 0.2]), (at := np.array([[1.0, 2.0, np.pi / 2]])), reported(at)
    )
    np.testing.assert_allclose(seen, [[0.8, 2.5, np.pi / 2]], atol=1e-15)


@pytest.mark.parametrize("arm", [ARM, np.array([-2.0, 1.0])])
def test_robot_poses_are_the_inverse(rng, arm):
    poses = rng.uniform(-3, 3, (20, 3))
    np.testing.assert_allclose(
        EFFECT.robot_poses(arm, reported(EFFECT.seen(arm, poses, reported(poses)))),
        poses,
        atol=1e-12,
    )
