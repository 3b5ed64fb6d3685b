"""What the sensors record of a motion, as a run folder."""

import math
from dataclasses import asdict

import numpy as np

from odometry.io.run_folder import write_run_folder
from tests.blind.commands import RATE_HZ

POSE_PERIOD_S = 0.1
SIGMA_POSITION_M = 0.01
SIGMA_YAW_RAD = math.radians(0.23)
SIGMA_TREAD_M_S = 0.002
SIGMA_ATTITUDE_RAD = math.radians(0.1)
SIGMA_GYRO_RAD_S = 0.003


def record(folder, motion, body, effects, *, rng, noise):
    """Write a motion as its sensors saw it; `noise` is a factor of the pose's noise.

    Run time begins at 0 or at a larger number, and poses lie between stamps of odometry.
    """
    start_s = float(rng.choice([0.0, rng.integers(100, 5000) / 4]))
    phase_s = float(rng.integers(0, 20)) / 1000
    times_s = np.arange(phase_s, (len(motion.commands_m_s) - 1) / RATE_HZ, POSE_PERIOD_S)
    poses = pose_measured(motion, times_s, effects)
    sigma = noise * np.array([SIGMA_POSITION_M, SIGMA_POSITION_M, SIGMA_YAW_RAD])
    poses = poses + sigma * rng.standard_normal(poses.shape)
    delay_s = effects.get("time_offset", {}).get("delay_s", 0.0)
    tables = {
        "odometry": _odometry(motion, start_s, rng),
        "pose": {
            "t": start_s + times_s + delay_s,
            "x": poses[:, 0],
            "y": poses[:, 1],
            "yaw": np.angle(np.exp(1j * poses[:, 2])),
        },
    }
    write_run_folder(folder, {"robot": asdict(body)}, tables)
    return folder


def pose_measured(motion, times_s, effects):
    """x, y and yaw (K, 3) of a sensor without noise, from the true motion at these times."""
    x, y, roll, pitch, yaw = motion.at(times_s).T
    arm = effects.get("lever_arm", {"x": 0.0, "y": 0.0})
    along = np.cos(pitch) * arm["x"] + np.sin(pitch) * np.sin(roll) * arm["y"]
    place = x + 1j * y + np.exp(1j * yaw) * (along + 1j * np.cos(roll) * arm["y"])
    offset = effects.get("heading_offset", {"yaw": 0.0})["yaw"]
    return np.column_stack([place.real, place.imag, yaw + offset])


def _odometry(motion, start_s, rng):
    stamps = np.arange(len(motion.commands_m_s)) / RATE_HZ
    stride = round(1 / (RATE_HZ * motion.step_s))
    attitude = motion.poses[::stride, 2:4]
    truth = np.column_stack([motion.commands_m_s, attitude, motion.yaw_rates_rad_s[::stride]])
    sigma = np.repeat([SIGMA_TREAD_M_S, SIGMA_ATTITUDE_RAD, SIGMA_GYRO_RAD_S], [2, 2, 1])
    recorded = truth + sigma * rng.standard_normal(truth.shape)
    names = ("v_left", "v_right", "roll", "pitch", "gyro_z")
    columns = {"t": start_s + stamps, **dict(zip(names, recorded.T, strict=True))}
    return columns if motion.labels is None else columns | {"terrain": motion.labels}
