"""What noise explains of a window, beside simulated noise."""

import itertools
from dataclasses import replace

import numpy as np
import pytest

from odometry.windows.dense.dense_noise import Factors, Noise, estimated_noise, whitening

DRAWS = 20_000
NOISE = Noise(position_m=0.004, yaw_rad=0.003, wander_m=0.006, wander_rad=0.004)


def in_first_frame(places, yaws):
    """Motion (..., n, 3) from the first of poses given as complex places and yaws."""
    moved = (places[..., 1:] - places[..., :1]) * np.exp(-1j * yaws[..., :1])
    return np.stack([moved.real, moved.imag, yaws[..., 1:] - yaws[..., :1]], axis=-1)


def drawn_residuals(scene, window, noise, rng):
    """Residuals (DRAWS, 3 n) of a robot that wanders, and of poses that are not exact.

    Every step between poses turns the robot by chance, then moves it as it was measured, then
    displaces it by chance; both grow with the root of its wheel travel.
    """
    measured = scene.poses[scene.windows[window]]
    places, yaws = measured[:, 0] + 1j * measured[:, 1], np.unwrap(measured[:, 2])
    speeds = np.abs(scene.inputs.tread_speeds_m_s).mean(axis=1)
    ends = np.searchsorted(scene.time_s, scene.pose_s[scene.windows[window]])
    travel_m = np.array(
        [(speeds[a:b] * scene.steps_s[a:b]).sum() for a, b in itertools.pairwise(ends)]
    )
    steps = np.diff(places) * np.exp(-1j * yaws[:-1])
    turned = np.cumsum(
        noise.wander_rad * np.sqrt(travel_m) * rng.standard_normal((DRAWS, len(steps))), axis=1
    )
    displaced = noise.wander_m * np.sqrt(travel_m) * complex_normal(rng, (DRAWS, len(steps)))
    true_yaws = np.concatenate([np.full((DRAWS, 1), yaws[0]), yaws[1:] + turned], axis=1)
    heading = yaws[:-1] + turned  # each step begins with its own chance turn
    added = steps * np.exp(1j * heading) + displaced
    true_places = np.concatenate(
        [np.full((DRAWS, 1), places[0]), places[0] + np.cumsum(added, axis=1)], axis=1
    )
    seen_places = true_places + noise.position_m * complex_normal(rng, true_places.shape)
    seen_yaws = true_yaws + noise.yaw_rad * rng.standard_normal(true_yaws.shape)
    difference = in_first_frame(seen_places, seen_yaws) - in_first_frame(places, yaws)
    return difference.reshape(DRAWS, -1)


def complex_normal(rng, shape):
    return rng.standard_normal(shape) + 1j * rng.standard_normal(shape)


@pytest.mark.parametrize(
    "noise",
    [
        Noise(NOISE.position_m, 1e-9, 1e-9, 1e-9),
        Noise(2e-4, NOISE.yaw_rad, 1e-9, 1e-9),
        Noise(2e-4, 2e-4, NOISE.wander_m, 1e-9),
        Noise(2e-4, 2e-4, 1e-9, NOISE.wander_rad),
        NOISE,
    ],
    ids=["position", "yaw", "wander", "turn", "all"],
)
def test_whitened_simulated_noise_is_white(make_scene, rng, noise):
    """The covariance of residuals by simulation, whitened by that of the formulae, is one."""
    scene = make_scene(5)
    window = 7
    white = whitening(scene, noise)[window]
    rows = drawn_residuals(scene, window, noise, rng) @ white.T
    assert np.abs(rows.mean(axis=0)).max() < 5 / np.sqrt(DRAWS)
    covariance = rows.T @ rows / DRAWS
    # entries of a sample covariance of white noise: 5 standard deviations
    limit = 5 * np.sqrt((1 + np.eye(len(covariance))) / DRAWS)
    assert (np.abs(covariance - np.eye(len(covariance))) < limit).all()


def test_each_window_is_whitened_by_its_own_motion(make_scene, rng):
    scene = make_scene(5)
    white = whitening(scene, NOISE)
    for window in (0, 31):
        rows = drawn_residuals(scene, window, NOISE, rng) @ white[window].T
        assert (rows**2).mean() == pytest.approx(1.0, abs=0.01)
    other = drawn_residuals(scene, 31, NOISE, rng) @ white[0].T
    assert abs((other**2).mean() - 1.0) > 0.02


@pytest.mark.parametrize(
    "noise", [NOISE, Noise(0.01, 0.004, 0.03, 0.02), Noise(0.02, 0.002, 0.02, 0.03)]
)
def test_the_most_likely_variances_are_the_true_ones(make_scene, rng, noise):
    """Within what Fisher's information of the windows used leaves open."""
    scenes = [make_scene(seed, duration_s=80.0) for seed in (5, 6)]
    residuals, information = [], np.zeros((4, 4))
    for scene in scenes:
        # no gyroscope, whose variance says nothing
        parts = [Factors(scene).covariance(one) for one in np.eye(5)[:4]]
        covariance = np.einsum("p,pkij->kij", noise.variances, parts)
        factor = np.linalg.cholesky(covariance)
        drawn = np.einsum("kij,kj->ki", factor, rng.standard_normal(factor.shape[:2]))
        residuals.append(drawn.reshape(len(scene), -1, 3))
        products = np.linalg.inv(covariance) @ parts
        information += np.einsum("pkij,qkji->pq", products, products) / 2
    off = estimated_noise(scenes, residuals).variances - noise.variances
    sigmas = np.sqrt(np.diag(np.linalg.inv(information)))
    assert (sigmas < 0.6 * noise.variances).all()
    windows_used = 60 / sum(map(len, scenes))
    assert off @ (windows_used * information) @ off < 18.5  # 99.9 % of chi-squared of four


def test_no_other_variances_are_more_likely(make_scene, rng):
    """Where a yaw drifts and a gyroscope follows the motion, which no sum of the five parts is.

    Scoring by expected information took the wandering turn and the gyroscope in turn for ever.
    """
    scene = make_scene(5, duration_s=80.0)
    rates = np.zeros(len(scene.time_s))
    scene = replace(scene, inputs=replace(scene.inputs, yaw_rate_rad_s=rates))
    count, steps, _ = scene.measured.shape
    drift = np.arange(1, steps + 1) * rng.normal(0, 3e-4, (count, 1))
    moved = rng.normal(0, 0.01, (count, steps, 3))
    moved[..., 2] = drift + rng.normal(0, 1e-3, (count, steps))
    gyroscope = np.diff(drift, axis=1, prepend=0.0) + rng.normal(0, 1e-5, (count, steps))
    rows = np.concatenate([moved.reshape(count, -1), gyroscope], axis=1)
    found = estimated_noise([scene], [rows])

    def likelihood(variances):
        white = whitening(scene, Noise(*np.sqrt(variances)))
        left = np.einsum("kij,kj->ki", white, rows)
        return np.log(np.diagonal(white, axis1=1, axis2=2)).sum() - np.sum(left**2) / 2

    best = likelihood(found.all_variances)
    for factors in itertools.product([1 / 1.5, 1.0, 1.5], repeat=5):
        assert likelihood(found.all_variances * factors) < best + 0.5


@pytest.mark.parametrize("far_m", [1.0, 1000.0])
def test_a_window_that_is_far_off_leaves_a_noise(make_scene, rng, far_m):
    """A search without an end goes to variances whose covariance is not definite in floats."""
    scene = make_scene(5, duration_s=80.0)
    rows = rng.normal(0.0, 0.01, scene.measured.shape)
    rows[3] *= 100.0 * far_m
    assert np.isfinite(estimated_noise([scene], [rows]).variances).all()
