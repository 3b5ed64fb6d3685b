"""How far poses scatter, by innovations that are drawn here."""

import numpy as np
import pytest

from odometry.modes.checks.pose_scatter import LEAST_POSES, WINDOW_S, pose_scatter
from odometry.modes.follow.track import follow_modes
from odometry.modes.models.innovation_test import Innovations
from odometry.modes.show.doubts import MOST_SCATTER
from tests.odometry.modes.mode_examples import run_of, traction_set

SIZE = 600  # at 20 Hz, with a pose at every fourth stamp
STAMPS_S = 0.05 * np.arange(SIZE)


def scatter_of(poses):
    """Of innovations (N, 3) of poses, and a yaw rate."""
    left = np.full((SIZE, 2, 4), np.nan)
    left[..., 3] = 0.5
    left[::4, :, :3] = poses[::4, None]
    return pose_scatter(Innovations(left, np.zeros(SIZE, dtype=int), STAMPS_S, 1.0))


def white(seed=4):
    return np.random.default_rng(seed).normal(size=(SIZE, 3))


@pytest.mark.parametrize("times", [1.0, 3.0])
def test_white_innovations_are_noise(times):
    found = scatter_of(times * white())
    assert np.isnan(found[STAMPS_S < WINDOW_S]).all()
    np.testing.assert_allclose(found[STAMPS_S > WINDOW_S + 0.1], times, rtol=0.25)


def test_a_few_poses_far_off_are_no_scatter():
    poses = white()
    poses[::40] += 30.0
    assert np.nanmax(scatter_of(poses)) < MOST_SCATTER


def test_what_lasts_is_motion_and_no_noise():
    turning = 8.0 * np.sin(2 * np.pi * STAMPS_S / 5.0)[:, None]
    assert np.isnan(scatter_of(white() + turning)[STAMPS_S > WINDOW_S + 0.1]).all()


def test_too_few_poses_determine_nothing():
    poses = white()
    kept = 4 * int(WINDOW_S / 0.2 / (LEAST_POSES - 2))
    poses[np.arange(SIZE) % kept > 0] = np.nan
    assert np.isnan(scatter_of(poses)).all()


@pytest.mark.slow
def test_noisier_poses_of_a_run_are_measured():
    """Modes expect 2 cm and 0.01 rad; the run has a half of it, then three times."""
    mode_set = traction_set()
    quiet = follow_modes(run_of(0.8, track_width=0.5, size=1500), mode_set)
    run = run_of(0.8, track_width=0.5, size=1500)
    rng = np.random.default_rng(2)
    for name, sigma in (("x", 0.06), ("y", 0.06), ("yaw", 0.03)):
        run.pose.columns[name][:] += sigma * rng.normal(size=len(run.pose))
    assert np.nanmax(quiet.scatter) < 1.2
    np.testing.assert_allclose(np.nanmedian(follow_modes(run, mode_set).scatter), 3.0, rtol=0.2)
