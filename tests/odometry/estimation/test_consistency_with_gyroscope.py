"""NEES and NIS of the filter with a gyroscope, over seeds, where its noises are the true ones.

The truth draws what the filter supposes: white noise of the position and of a yaw turned by the
gyroscope, a constant bias, ICRs and slip factors from the prior, and a yaw rate that differs from
that of the treads by the noise that their slip has.
"""

import math

import numpy as np
import pytest
from scipy.stats import chi2

from odometry.estimation.config import IcrEkfConfig
from odometry.estimation.icr_ekf import IcrEkf
from odometry.estimation.noise_scale import tread_variance
from odometry.parameters import ParameterSet, TerrainParameters
from odometry.recording.frames import Frame

WIDTH, STEP_S, STEPS, RUNS = 0.6, 0.1, 200, 40
VALUES = {"y_left": 0.5, "y_right": -0.45, "x_icr": -0.05, "alpha_left": 0.9, "alpha_right": 0.92}
SIGMAS = np.array([0.03, 0.03, 0.03, 0.02, 0.02])
CONFIG = IcrEkfConfig(
    position_sigma_m=0.03,
    yaw_sigma_rad=0.02,
    position_noise=0.02,
    slip_noise=0.0,
    gyro_noise=0.01,
    bias_noise=0.0,
    bias_sigma_rad_s=0.02,
    icr_noise_widths=0.0,
    alpha_noise=0.0,
    adapt_rate=0.0,
    tail_probability=1.0,
    gate_probability=1.0,
    watch_sensors=False,
)


def speeds_at(time_s):
    return np.array([0.6 + 0.4 * math.sin(0.7 * time_s), 0.6 - 0.4 * math.sin(0.45 * time_s + 1)])


def drive_and_filter(seed):
    """True and estimated states at the end, and normalised innovations squared."""
    rng = np.random.default_rng(seed)
    table = TerrainParameters("icr", VALUES, tuple(VALUES), np.diag(SIGMAS**2))
    ekf = IcrEkf(WIDTH, ParameterSet({"a": table}), CONFIG)
    y_left, y_right, x_icr, alpha_left, alpha_right = np.array(
        list(VALUES.values())
    ) + SIGMAS * rng.normal(size=5)
    bias = CONFIG.bias_sigma_rad_s * rng.normal()
    pose_sigma = np.array([CONFIG.position_sigma_m] * 2 + [CONFIG.yaw_sigma_rad])
    x, y, yaw = 0.0, 0.0, 0.0
    estimate = ekf.start(Frame(0.0, speeds_at(0), 0, pose_sigma * rng.normal(size=3), None), "a")
    squared = []
    for k in range(1, STEPS + 1):
        left, right = speeds_at((k - 1) * STEP_S)
        of_treads = (alpha_right * right - alpha_left * left) / (y_left - y_right)
        spread = math.sqrt(tread_variance(np.array([left, right]), of_treads, WIDTH, 1.0, STEP_S))
        omega = of_treads + spread * rng.normal()
        for _ in range(10):
            h = STEP_S / 10
            ahead = (alpha_left * left + alpha_right * right) / 2 + (y_left + y_right) / 2 * omega
            aside, middle = -x_icr * omega, yaw + omega * h / 2
            x += (ahead * math.cos(middle) - aside * math.sin(middle)) * h
            y += (ahead * math.sin(middle) + aside * math.cos(middle)) * h
            yaw += omega * h
            x, y = (v + CONFIG.position_noise * math.sqrt(h) * rng.normal() for v in (x, y))
            yaw += CONFIG.gyro_noise * math.sqrt(h) * rng.normal()
        pose = None
        if k % 2 == 0:
            pose = np.array([x, y, yaw]) + pose_sigma * rng.normal(size=3)
            pose[2] = np.angle(np.exp(1j * pose[2]))
        frame = Frame(k * STEP_S, speeds_at(k * STEP_S), k, pose, None, False, omega + bias)
        estimate = ekf.step(estimate, frame, "a")
        if pose is not None:
            squared.append(estimate.innovation.normalised_squared)
    truth = np.array([x, y, yaw, y_left, y_right, x_icr, bias, alpha_left, alpha_right])
    error = estimate.mean - truth
    error[2] = np.angle(np.exp(1j * error[2]))
    return error, estimate.covariance, np.array(squared)


@pytest.fixture(scope="module")
def drives():
    return [drive_and_filter(seed) for seed in range(RUNS)]


@pytest.mark.parametrize("places", [range(9), range(3), (3, 4, 5, 7, 8), (6,)], ids=str)
def test_nees_lies_in_its_bounds(drives, places):
    """Sum over drives: chi-squared with runs times states degrees, 99 % two-sided."""
    chosen = list(places)
    total = sum(
        error[chosen] @ np.linalg.solve(covariance[np.ix_(chosen, chosen)], error[chosen])
        for error, covariance, _ in drives
    )
    low, high = chi2.ppf([0.005, 0.995], RUNS * len(chosen))
    assert low < total < high


def test_nis_lies_in_its_bounds(drives):
    """Innovations of one drive are independent: all count."""
    squared = np.concatenate([of for _, _, of in drives])
    low, high = chi2.ppf([0.025, 0.975], 3 * len(squared)) / len(squared)
    assert low < squared.mean() < high
