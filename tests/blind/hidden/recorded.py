"""What the sensors record of a motion: a run folder."""

from dataclasses import asdict

import numpy as np

from odometry.io.run_folder import write_run_folder
from tests.blind.commands import RATE_HZ
from tests.blind.hidden.scene import STEP_S


def record(folder, motion, scene, *, rng, noise):
    """Write a motion; `noise` is a factor of the noise of poses.

    Run time begins at 0 or at a larger number, and poses lie between stamps of odometry.
    """
    start_s = float(rng.choice([0.0, rng.integers(100, 5000) / 4]))
    phase_s = float(rng.integers(0, 20)) / 1000
    poses = _noisy(seen(motion, scene, phase_s), scene.sensors, rng, noise)
    tables = {"odometry": _odometry(motion, scene, rng), "pose": poses}
    if scene.sensors.gyroscope == "imu":
        tables["imu"] = _imu(motion, scene.sensors, rng)
    for table in tables.values():
        table["t"] = start_s + table["t"]
    write_run_folder(folder, {"robot": asdict(scene.body)}, tables)
    return folder


def seen(motion, scene, phase_s=0.0):
    """Stamps (K,) [s] and poses (K, 3) of the reference without noise."""
    duration_s = motion.drive.clock.duration_s
    times_s = np.arange(phase_s, duration_s, scene.sensors.pose_period_s)
    return motion.hidden.reference(times_s, motion.at(times_s)[:, [0, 1, 4]])


def _noisy(stamped, sensors, rng, noise):
    stamps_s, poses = stamped
    sigma = noise * np.array([sensors.sigma_position_m] * 2 + [sensors.sigma_yaw_rad])
    x, y, yaw = (poses + sigma * rng.standard_normal(poses.shape)).T
    return {"t": stamps_s, "x": x, "y": y, "yaw": np.angle(np.exp(1j * yaw))}


def _odometry(motion, scene, rng):
    sensors = scene.sensors
    every = slice(None, None, sensors.odometry_rows * round(1 / (RATE_HZ * STEP_S)))
    times_s = motion.drive.clock.times_s[every]
    columns = {"t": times_s}
    for name, values in zip(("v_left", "v_right"), motion.reported_m_s.T, strict=True):
        columns[name] = values[every] + sensors.sigma_tread_m_s * rng.standard_normal(len(times_s))
    for name, values in zip(("roll", "pitch"), motion.poses[:, 2:4].T, strict=True):
        sigma = sensors.sigma_attitude_rad
        columns[name] = values[every] + sigma * rng.standard_normal(len(times_s))
    if sensors.gyroscope == "odometry":
        columns["gyro_z"] = _gyroscope(motion, sensors, rng)[every]
    if motion.drive.labels is not None:
        columns["terrain"] = motion.drive.labels[every]
    return columns


def _imu(motion, sensors, rng):
    return {"t": motion.drive.clock.times_s, "gyro_z": _gyroscope(motion, sensors, rng)}


def _gyroscope(motion, sensors, rng):
    rates = motion.hidden.gyroscope(motion.yaw_rates_rad_s)
    return rates + sensors.sigma_gyroscope_rad_s * rng.standard_normal(len(rates))
