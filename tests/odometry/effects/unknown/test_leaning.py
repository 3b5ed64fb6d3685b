"""An antenna on a mast moves over the robot as rotations say, by differences of its own place."""

import numpy as np

from odometry.effects.unknown.leaning import leaning
from odometry.effects.unknown.residual_variables import variable_of
from odometry.geometry.se3 import rotation_from_roll_pitch_yaw
from odometry.models.inputs import Inputs

TIME_S = 0.01 * np.arange(400)
OMEGA = 0.7
ROLL, PITCH, YAW = 0.2 * np.sin(TIME_S), 0.15 * np.cos(1.3 * TIME_S), OMEGA * TIME_S
TWIST = np.column_stack([np.ones(400), np.zeros(400), np.full(400, OMEGA)])


def inputs(roll=ROLL, pitch=PITCH):
    return Inputs(np.ones((400, 2)), roll_rad=roll, pitch_rad=pitch, time_s=TIME_S)


def test_it_is_the_velocity_of_the_top_in_the_frame_of_the_robot():
    top = np.array(
        [
            rotation_from_roll_pitch_yaw(angles) @ [0.0, 0.0, 1.0]
            for angles in zip(ROLL, PITCH, YAW, strict=True)
        ]
    )
    over_world = (np.diff(top[:, 0]) + 1j * np.diff(top[:, 1])) / np.diff(TIME_S)
    in_robot = over_world * np.exp(-1j * YAW[:-1])
    found = [leaning(TWIST, inputs(), axis)[:-1] for axis in (0, 1)]
    np.testing.assert_allclose(found[0], in_robot.real, atol=2e-3)
    np.testing.assert_allclose(found[1], in_robot.imag, atol=2e-3)


def test_on_one_slope_the_top_stays_where_it_is_as_the_robot_turns():
    """A plane that falls by 0.1 rad: its attitude follows from the yaw."""
    pitch = np.arcsin(np.sin(0.1) * np.cos(YAW))
    roll = np.arcsin(np.sin(0.1) * np.sin(YAW) / np.cos(pitch))
    for axis in (0, 1):
        assert np.abs(leaning(TWIST, inputs(roll, pitch), axis)[:-1]).max() < 1e-3


def test_without_attitude_nothing_leans():
    level = Inputs(np.ones((400, 2)), time_s=TIME_S)
    np.testing.assert_array_equal(leaning(TWIST, level, 0), 0.0)
    assert variable_of("leaning_left", Inputs(np.ones((400, 2))), TWIST) is None
