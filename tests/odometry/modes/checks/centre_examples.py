"""Runs of a robot that turns about a point which is given, and modes that do."""

from dataclasses import replace
from pathlib import Path

import numpy as np

from odometry.modes.models.response import lagged
from odometry.recording.run import Robot, Run
from odometry.tables.table import Table
from tests.odometry.modes.mode_examples import traction_set

STEP_S, WIDTH, SPEED_M_S, TURN = 0.02, 0.5, 0.5, 0.5


def centre_set(ahead_m=0.0, spread=0.02):
    """Two modes that turn about a point so far ahead of the origin."""
    mode_set = traction_set((TURN, 0.8))
    gains = mode_set.modes.gains.copy()
    gains[:, :, 1, 1] = -ahead_m * gains[:, :, 2, 1]
    modes = replace(mode_set.modes, gains=gains)
    stated = {"centre_spread": np.full((2, 2), spread), "centre_noise": np.ones((2, 2))}
    return replace(mode_set, modes=replace(modes, **stated) if spread else modes)


def centre_run(
    ahead_m=0.0, left_m=0.0, *, lag_s=0.0, late_s=0.0, drift_m_s=0.0, slide_m=0.0, **other
):
    """Turns of `turn_s` every 4 s to both sides; ahead_m and late_s are one for all rows, or each.

    The yaw rate follows by a lag, poses are late, and the robot drifts by the time or by the turn.
    """
    kept = {"lasts_s": 40.0, "turn_s": 4.0, "pose_rows": 5, "seed": 3, "folder": "drive"} | other
    t = STEP_S * np.arange(round(kept["lasts_s"] / STEP_S))
    rng = np.random.default_rng(kept["seed"])
    half = np.repeat(rng.uniform(0.1, 0.3, len(t) // 200 + 1), 200)[: len(t)]
    half = np.where(t % 4 < kept["turn_s"], half, 0.0)
    half = lagged(half * np.where((t / 4).astype(int) % 3, 1.0, -1.0), t, 0.2)
    omega = lagged(TURN * 2 * half / WIDTH, t, lag_s)
    yaw = np.append(0.0, np.cumsum(omega[:-1]) * STEP_S)
    velocity = SPEED_M_S + omega * (left_m - 1j * np.broadcast_to(ahead_m, t.shape))
    velocity = velocity * np.exp(1j * (yaw + omega * STEP_S / 2)) + drift_m_s
    place = np.append(0.0, np.cumsum((velocity + slide_m * np.abs(omega))[:-1]) * STEP_S)
    then = np.maximum(t - late_s, 0.0)
    noise = rng.standard_normal((3, len(t))) * np.array([[0.005], [0.005], [0.002]])
    poses = [np.interp(then, t, of) for of in (place.real, place.imag, yaw)] + noise
    odometry = {"t": t, "v_left": SPEED_M_S - half, "v_right": SPEED_M_S + half, "gyro_z": omega}
    pose = dict(
        zip(("t", "x", "y", "yaw"), np.vstack([t, poses])[:, :: kept["pose_rows"]], strict=True)
    )
    tables = [Table(Path("t.csv"), c, np.arange(len(c["t"])) + 2) for c in (odometry, pose)]
    return Run(Path(kept["folder"]), Robot(WIDTH, length=0.8), {}, *tables)
