import numpy as np

from odometry.effects.measurement.sensor_mount import HeadingOffset
from tests.odometry.effects.reports import reported

EFFECT = HeadingOffset()


def test_positions_stay_and_headings_turn(rng):
    poses = rng.uniform(-3, 3, (10, 3))
    seen = EFFECT.seen(np.array([0.2]), poses, reported(poses))
    np.testing.assert_array_equal(seen[:, :2], poses[:, :2])
    np.testing.assert_allclose(seen[:, 2] - poses[:, 2], 0.2, atol=1e-15)
    np.testing.assert_allclose(
        EFFECT.robot_poses(np.array([0.2]), reported(seen)), poses, atol=1e-15
    )


def test_straight_ahead_seems_to_drift_to_one_side():
    """From the sensor's first heading, turned left by 0.1, the robot drifts to the right."""
    poses = np.column_stack([np.linspace(0, 2, 5), np.zeros(5), np.zeros(5)])
    yaw = EFFECT.seen(np.array([0.1]), poses, reported(poses))[0, 2]
    across = -np.sin(yaw) * poses[:, 0] + np.cos(yaw) * poses[:, 1]
    np.testing.assert_allclose(across, -poses[:, 0] * np.sin(0.1), atol=1e-15)
