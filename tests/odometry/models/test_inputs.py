"""Inputs of models: tilt of every sample, and stacks that are cut and joined."""

from dataclasses import replace

import numpy as np
import pytest

from odometry.models.inputs import Inputs, joined


@pytest.fixture
def tilted(rng):
    roll, pitch = rng.uniform(-0.4, 0.4, (2, 6))
    return Inputs(rng.normal(size=(6, 2)), roll, pitch, time_s=np.arange(6.0))


def test_tilt_is_that_of_every_sample(tilted):
    roll, pitch = tilted.roll_rad, tilted.pitch_rad
    expected = [np.sin(roll), np.cos(roll), np.sin(pitch), np.cos(pitch)]
    np.testing.assert_array_equal(tilted.tilt, expected)
    assert tilted.tilt is tilted.tilt


@pytest.mark.parametrize(("roll", "pitch"), [(0.1, 0.0), (0.0, 0.1)])
def test_one_angle_is_a_tilt(roll, pitch):
    inputs = Inputs(np.zeros((3, 2)), np.array([0.0, roll, 0.0]), np.array([0.0, pitch, 0.0]))
    assert inputs.tilt is not None
    np.testing.assert_allclose(inputs.tilt.cos_roll * inputs.tilt.cos_pitch, [1, np.cos(0.1), 1])


def test_level_ground_has_no_tilt():
    assert Inputs(np.zeros((3, 2))).tilt is None


def test_a_tilt_once_requested_is_not_carried_over(tilted):
    """To rows of the stack, to another attitude, or to stacks end to end."""
    assert tilted.tilt is not None
    np.testing.assert_array_equal(tilted.rows(slice(1, 3)).tilt, np.array(tilted.tilt)[:, 1:3])
    level = replace(tilted, roll_rad=np.zeros(6), pitch_rad=np.zeros(6))
    assert level.tilt is None
    np.testing.assert_array_equal(
        joined([level, tilted]).tilt.sin_roll, np.append(np.zeros(6), tilted.tilt.sin_roll)
    )


def test_rows_end_to_end_are_the_stack(tilted):
    whole = joined([tilted.rows(slice(2)), tilted.rows(np.arange(2, 6))])
    for name in ("tread_speeds_m_s", "roll_rad", "pitch_rad", "time_s"):
        np.testing.assert_array_equal(getattr(whole, name), getattr(tilted, name))
    assert whole.accelerations_m_s2 is None


def test_what_one_stack_lacks_all_lack_end_to_end(tilted):
    pushed = replace(tilted, accelerations_m_s2=np.ones((6, 2)))
    assert joined([tilted, pushed]).accelerations_m_s2 is None
    assert joined([pushed, tilted]).accelerations_m_s2 is None
    np.testing.assert_array_equal(joined([pushed, pushed]).accelerations_m_s2, np.ones((12, 2)))
