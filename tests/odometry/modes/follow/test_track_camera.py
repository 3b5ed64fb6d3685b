"""Labels of images beside the motion, where this leaves the terrain open."""

import numpy as np
import pytest

from odometry.errors import ParameterError
from odometry.modes.follow.camera_prior import SeenTerrain
from odometry.modes.follow.track import follow_modes
from tests.odometry.modes.follow.test_track import NAMES, SET, SIGMA, STEP_S, A, B
from tests.odometry.modes.mode_drives import run_of_tables, velocities, wandering


@pytest.fixture(scope="module")
def straight():
    """Both terrains move the same when treads go together."""
    rng, size = np.random.default_rng(4), 500
    treads = np.repeat(wandering(rng, size, STEP_S)[:, :1], 2, axis=1)
    true = velocities([A[0]] * size, [B[0]] * size, treads, STEP_S)
    seen = true + SIGMA * rng.normal(size=true.shape)
    t = STEP_S * np.arange(size)
    odometry = {"t": t, "v_left": treads[:, 0], "v_right": treads[:, 1], "gyro_z": seen[:, 1]}
    return run_of_tables(odometry, velocity={"t": t, "vx": seen[:, 0], "wz": seen[:, 1]})


def test_a_straight_leaves_it_open(straight):
    assert follow_modes(straight, SET).probabilities.max() < 0.9


def test_the_camera_decides_what_motion_leaves_open(straight):
    """From the place of the label on, and not before; a label of even odds changes nothing."""
    motion = follow_modes(straight, SET).probabilities
    for column, name in enumerate(NAMES):
        with_camera = follow_modes(
            straight, SET, seen=(SeenTerrain(4.0, name, 0.98),)
        ).probabilities
        row = round(4.0 / STEP_S)
        np.testing.assert_array_equal(with_camera[:row], motion[:row])
        assert (with_camera[row:, column] > motion[row:, column]).all()
        assert (with_camera[round(8.0 / STEP_S) :, column] > 0.8).all()  # settles at 1.01 of 1.06
    guessed = follow_modes(straight, SET, seen=(SeenTerrain(4.0, "tar", 0.5),)).probabilities
    np.testing.assert_allclose(guessed, motion, atol=1e-12)


def test_a_robot_that_stands_learns_from_the_camera_alone():
    """Rates from ice to tar and back: 1/20 a second, and 0.8 more for odds of 0.9 from 2 s on."""
    t = STEP_S * np.arange(500)
    still = {"t": t, "v_left": 0 * t, "v_right": 0 * t, "gyro_z": 0.3 * np.sin(t)}
    track = follow_modes(run_of_tables(still), SET, seen=(SeenTerrain(2.0, "tar", 0.9),))
    there, back = 0.05 + 0.8, 0.05
    settled = there / (there + back)
    left = np.exp(-(there + back) * np.maximum(t - 2.0 + STEP_S, 0.0))
    np.testing.assert_allclose(track.probabilities[:, 1], settled + (0.5 - settled) * left)
    assert np.isnan(track.normalised_squared).all()


def test_a_label_that_is_no_mode_is_refused(straight):
    with pytest.raises(ParameterError, match="'mud'"):
        follow_modes(straight, SET, seen=(SeenTerrain(1.0, "mud", 0.9),))
