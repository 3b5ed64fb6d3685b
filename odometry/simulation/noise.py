"""Noise of simulated sensors and slow disturbances; the generator is always passed in."""

import numpy as np

from odometry.arrays import FloatArray


def ornstein_uhlenbeck(
    count: int, step_s: float, sigma: FloatArray, time_constant_s: float, rng: np.random.Generator
) -> FloatArray:
    """Slowly varying disturbances that return to zero, exact at any step.

    Parameters
    ----------
    count : int
        Number of samples.
    step_s : float
        Time between samples [s].
    sigma : (n,) array
        Standard deviation of each component at any time.
    time_constant_s : float
        Time in which the autocorrelation falls to 1/e [s].
    rng : numpy.random.Generator
        Source of the noise.

    Returns
    -------
    (count, n) array
        Samples of the stationary process.
    """
    keep = np.exp(-step_s / time_constant_s)
    white = rng.standard_normal((count, len(sigma)))
    samples = np.empty_like(white)
    samples[0] = white[0]
    for k in range(1, count):
        samples[k] = keep * samples[k - 1] + np.sqrt(1 - keep**2) * white[k]
    return np.asarray(samples * sigma)


def measured_poses(
    poses_world: FloatArray, sigma_position_m: float, sigma_yaw_rad: float, rng: np.random.Generator
) -> FloatArray:
    """Poses (N, 3) as x, y, yaw with independent Gaussian noise; yaw wrapped to (-pi, pi]."""
    sigma = np.array([sigma_position_m, sigma_position_m, sigma_yaw_rad])
    noisy = poses_world + sigma * rng.standard_normal(poses_world.shape)
    noisy[:, 2] = np.pi - np.mod(np.pi - noisy[:, 2], 2 * np.pi)
    return np.asarray(noisy)
