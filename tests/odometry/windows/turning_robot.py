"""A robot that turns often and fast, by plain sums at 100 Hz with no code of the packages."""

from pathlib import Path

import numpy as np

from odometry.recording.run import Robot, Run
from odometry.tables.table import Table

STEP_S = 0.01
WIDTH_M = 0.5  # stated; the effective width is 0.6 to 2 times as large


def table(**columns):
    return Table(Path("table.csv"), columns, np.arange(len(columns["t"])) + 2)


def turning_run(
    seed, rate_hz, dropped, *, bias_rad_s=None, duration_s=120.0, fastest_rad_s=3.0, slip=0.1
):
    """A run and the true yaw (M,) of its poses, not wrapped; no gyroscope without a bias."""
    rng = np.random.default_rng(seed)
    count = round(duration_s / STEP_S)
    t = np.arange(count) * STEP_S
    held = rng.integers(50, 400, size=count // 50)

    def commanded(low, high):
        values = rng.uniform(low, high, len(held)) * (rng.random(len(held)) < 0.8)
        return np.repeat(values, held)[:count]

    forward, asked = commanded(-0.5, 1.0), commanded(-fastest_rad_s, fastest_rad_s)
    knots_s = np.arange(0.0, duration_s + 5.0, 5.0)
    omega = asked * (1 + slip * np.interp(t, knots_s, rng.normal(size=len(knots_s))))
    half_m_s = asked * WIDTH_M * rng.uniform(0.6, 2.0) / 2
    yaw = np.cumsum(np.append(0.0, omega[:-1])) * STEP_S
    x, y = (np.cumsum(forward * of(yaw)) * STEP_S for of in (np.cos, np.sin))
    rows = slice(None, None, 5)
    odometry = {
        "t": t[rows],
        "v_left": (forward - half_m_s)[rows],
        "v_right": (forward + half_m_s)[rows],
    }
    if bias_rad_s is not None:
        noise = 0.01 * rng.normal(size=len(t[rows]))
        odometry["gyro_z"] = omega[rows] + bias_rad_s + noise
    poses = np.arange(0, count, round(1 / rate_hz / STEP_S))
    poses = poses[rng.random(len(poses)) >= dropped]
    measured = yaw[poses] + 0.02 * rng.normal(size=len(poses))
    wrapped = np.arctan2(np.sin(measured), np.cos(measured))
    pose = table(t=t[poses], x=x[poses], y=y[poses], yaw=wrapped)
    return Run(Path("turning"), Robot(WIDTH_M), {}, table(**odometry), pose), measured
