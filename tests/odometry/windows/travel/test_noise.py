"""Closed forms against finite differences, and against many draws of noisy poses.

An element of a sample covariance of n draws has the standard deviation
sqrt((S_ii S_jj + S_ij^2) / n); five of them are allowed.
"""

import numpy as np
import pytest

from odometry.windows.config import WindowConfig
from odometry.windows.travel.noise import (
    by_pose_noise,
    pose_variances,
    score_covariance,
    window_covariances,
)
from odometry.windows.travel.windows import windows_of

DRAWS = 20_000
CONFIG = WindowConfig(stride=0.5, position_sigma_m=0.01, yaw_sigma_rad=0.005)


def between(first, second):
    difference = second - first
    cosine, sine = np.cos(first[..., 2]), np.sin(first[..., 2])
    x = cosine * difference[..., 0] + sine * difference[..., 1]
    y = -sine * difference[..., 0] + cosine * difference[..., 1]
    turn = np.remainder(difference[..., 2] + np.pi, 2 * np.pi) - np.pi
    return np.stack([x, y, turn], axis=-1)


def moved(pose, noise):
    """Noise in the pose's own frame."""
    noise = np.broadcast_to(noise, np.broadcast_shapes(noise.shape, pose.shape))
    cosine, sine = np.cos(pose[..., 2]), np.sin(pose[..., 2])
    x = cosine * noise[..., 0] - sine * noise[..., 1]
    y = sine * noise[..., 0] + cosine * noise[..., 1]
    return pose + np.stack([x, y, noise[..., 2]], axis=-1)


@pytest.fixture(scope="module")
def windows(winding):
    every = windows_of([winding], CONFIG)
    return every.where(np.arange(len(every)) < 12)


@pytest.fixture(scope="module")
def poses(winding, windows):
    return winding.pose.stack("x", "y", "yaw")[: windows.last_pose.max() + 1]


@pytest.fixture(scope="module")
def draws(windows, poses):
    """How noisy poses change the measured motions: (DRAWS, K, 3)."""
    rng = np.random.default_rng(3)
    noise = rng.standard_normal((DRAWS, len(poses), 3)) * [0.01, 0.01, 0.005]
    seen = moved(poses, noise)
    ends = between(seen[:, windows.first_pose], seen[:, windows.last_pose]) - windows.measured
    ends[..., 2] = np.remainder(ends[..., 2] + np.pi, 2 * np.pi) - np.pi
    return ends


def assert_is_covariance_of(stated, samples):
    found = np.cov(samples, rowvar=False)
    diagonal = np.diag(stated)
    deviation = np.sqrt((np.outer(diagonal, diagonal) + stated**2) / len(samples))
    assert np.all(np.abs(found - stated) < 5 * deviation)


def test_variances_are_those_of_the_settings():
    np.testing.assert_allclose(pose_variances(CONFIG), [1e-4, 1e-4, 2.5e-5], rtol=1e-14)


def test_derivatives_by_the_noise_of_both_ends(windows, poses):
    at_start, at_end = by_pose_noise(windows)
    starts, ends, h = poses[windows.first_pose], poses[windows.last_pose], 1e-6
    for i, e in enumerate(h * np.eye(3)):
        by_start = between(moved(starts, e), ends) - between(moved(starts, -e), ends)
        by_end = between(starts, moved(ends, e)) - between(starts, moved(ends, -e))
        np.testing.assert_allclose(at_start[:, :, i], by_start / (2 * h), rtol=0, atol=1e-8)
        np.testing.assert_allclose(at_end[:, :, i], by_end / (2 * h), rtol=0, atol=1e-8)


def test_covariance_of_each_window_by_many_draws(windows, draws):
    stated = window_covariances(windows, pose_variances(CONFIG))
    for k in range(len(windows)):
        assert_is_covariance_of(stated[k], draws[:, k])


@pytest.mark.parametrize("motion", [(0, 0, 0), (4e-4, 1e-4, 1e-5)], ids=["poses", "and motion"])
def test_covariance_of_the_gradient_by_many_draws(windows, draws, motion):
    """Neighbours share poses: overlapping windows every second one, besides."""
    shared = set(windows.first_pose) & set(windows.last_pose)
    assert len(shared) > 3
    rng = np.random.default_rng(4)
    gradients = rng.normal(size=(len(windows), 4, 3)) * [1, 1, 3]
    own = rng.standard_normal(draws.shape) * np.sqrt(motion)
    own *= np.sqrt(windows.travel_m)[:, None]
    scores = np.einsum("kfi,nki->nf", gradients, draws + own)
    stated = score_covariance(windows, gradients, pose_variances(CONFIG), np.array(motion))
    assert_is_covariance_of(stated, scores)
