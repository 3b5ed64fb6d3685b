"""The ICR filter against a textbook EKF that shares no equation with it.

The textbook's continuous-discrete EKF: Chen 2023 eq. 3 and 4 as printed (in Chen's own x_G, which
is -x_icr), mean and covariance integrated together by Runge-Kutta steps from dx/dt = f(x) and
dP/dt = A P + P A^T + Q with A from complex steps; the update is eq. 14 to 16 as printed.
"""

import numpy as np

from odometry.estimation.config import PAPER, IcrEkfConfig
from odometry.estimation.icr_ekf import IcrEkf
from odometry.parameters import ParameterSet, TerrainParameters
from odometry.recording.frames import Frame

WIDTH = 0.5
TO_CHEN = np.diag([1.0, 1, 1, 1, 1, -1])  # x_G = -x_icr
R = np.diag([0.02**2, 0.02**2, 0.01**2])
H = np.eye(3, 6)
SUBSTEPS = 10


def rate(state, v_l, v_r):
    """Chen eq. 4 with eq. 3, without noise."""
    theta, y_l, y_r, x_g = state[2:]
    v_x = (v_r * y_l - v_l * y_r) / (y_l - y_r)
    v_y = -(v_l - v_r) * x_g / (y_l - y_r)
    omega = -(v_l - v_r) / (y_l - y_r)
    return np.array(
        [
            v_x * np.cos(theta) - v_y * np.sin(theta),
            v_x * np.sin(theta) + v_y * np.cos(theta),
            omega,
            0 * omega,
            0 * omega,
            0 * omega,
        ]
    )


def slope(state, v_l, v_r):
    """The derivative of `rate` by complex steps, exact to rounding."""
    return np.column_stack([rate(state + 1e-30j * e, v_l, v_r).imag / 1e-30 for e in np.eye(6)])


def predicted(mean, covariance, speeds, step_s, density):
    def rates(mean, covariance):
        A = slope(mean, *speeds)
        return rate(mean, *speeds), A @ covariance + covariance @ A.T + np.diag(density)

    h = step_s / SUBSTEPS
    for _ in range(SUBSTEPS):
        m1, p1 = rates(mean, covariance)
        m2, p2 = rates(mean + h / 2 * m1, covariance + h / 2 * p1)
        m3, p3 = rates(mean + h / 2 * m2, covariance + h / 2 * p2)
        m4, p4 = rates(mean + h * m3, covariance + h * p3)
        mean = mean + h / 6 * (m1 + 2 * m2 + 2 * m3 + m4)
        covariance = covariance + h / 6 * (p1 + 2 * p2 + 2 * p3 + p4)
    return mean, covariance


def updated(mean, covariance, pose):
    innovation = pose - H @ mean
    innovation[2] = np.arctan2(np.sin(innovation[2]), np.cos(innovation[2]))
    K = covariance @ H.T @ np.linalg.inv(H @ covariance @ H.T + R)  # eq. 14
    return mean + K @ innovation, (np.eye(6) - K @ H) @ covariance  # eq. 15, 16


def both_filters(rng, noise, steps, longest_step_s):
    """Random steps, speeds and poses through both; pairs of (mean, covariance) in Chen's signs."""
    table = TerrainParameters("icr", {"y_left": 0.45, "y_right": -0.35, "x_icr": 0.08})
    config = IcrEkfConfig(
        **PAPER,
        position_sigma_m=0.02,
        yaw_sigma_rad=0.01,
        position_noise=noise[0],
        yaw_noise=noise[1],
        icr_noise_widths=noise[2] / WIDTH,
        gate_probability=1.0,
    )
    ekf = IcrEkf(WIDTH, ParameterSet({"a": table}), config)
    density = np.square([noise[0], noise[0], noise[1], noise[2], noise[2], noise[2]])
    stamp_s, speeds = 0.0, rng.uniform(-1, 1, 2)
    estimate = ekf.start(Frame(0.0, speeds, 0, np.array([1.0, -2.0, 3.0]), None), "a")
    mean = np.array([1.0, -2.0, 3.0, 0.45, -0.35, -0.08])
    covariance = np.zeros((6, 6))
    covariance[:3, :3] = R
    covariance[3:, 3:] = (config.reset_sigma_widths * WIDTH) ** 2 * np.eye(3)
    for k in range(steps):
        step_s = rng.uniform(0.01, longest_step_s)
        mean, covariance = predicted(mean, covariance, speeds, step_s, density)
        pose = None
        if k % 3:
            spread = np.linalg.cholesky(covariance[:3, :3] + R)
            pose = mean[:3] + spread @ rng.normal(size=3)
            pose[2] = np.angle(np.exp(1j * pose[2]))
            mean, covariance = updated(mean, covariance, pose)
        stamp_s, speeds = stamp_s + step_s, rng.uniform(-1, 1, 2)
        estimate = ekf.step(estimate, Frame(stamp_s, speeds, k, pose, None), "a")
        yield _in_chens_signs(estimate), (mean, covariance)


def _in_chens_signs(estimate):
    return TO_CHEN @ estimate.mean[:6], TO_CHEN @ estimate.covariance[:6, :6] @ TO_CHEN


def in_sigmas(ours, textbook):
    """Largest differences of mean and covariance, in the textbook's standard deviations."""
    (mean, covariance), (mean_0, covariance_0) = ours, textbook
    sigma = np.sqrt(np.diag(covariance_0))
    error = mean - mean_0
    error[2] = np.angle(np.exp(1j * error[2]))
    scaled = (covariance - covariance_0) / np.outer(sigma, sigma)
    return np.abs(error / sigma).max(), np.abs(scaled).max()


def test_without_process_noise_they_are_one_filter(rng):
    """400 steps of up to 0.3 s; what remains is the textbook's Runge-Kutta step of 0.03 s."""
    pairs = [in_sigmas(*pair) for pair in both_filters(rng, (0.0, 0.0, 0.0), 400, 0.3)]
    assert np.max(pairs) < 2e-6


def test_with_noise_in_position_they_are_one_filter(rng):
    """White noise in x and y alone does not pass through the motion: no rule is needed for it."""
    pairs = [in_sigmas(*pair) for pair in both_filters(rng, (0.05, 0.0, 0.0), 300, 0.1)]
    assert np.max(pairs) < 1e-8


def test_with_all_noises_they_differ_by_the_trapezium_rule(rng):
    """Steps of up to 0.1 s: its error is below a thousandth of a standard deviation."""
    pairs = [in_sigmas(*pair) for pair in both_filters(rng, (0.01, 0.01, 0.002), 300, 0.1)]
    assert np.max(pairs) < 1e-3
