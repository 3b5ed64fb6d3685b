"""Drives of which positions alone are measured, by code of their own."""

from dataclasses import replace
from pathlib import Path

import numpy as np

from odometry.recording.run import Robot, Run
from odometry.tables.table import Table

ICR = {"y_left": 0.45, "y_right": -0.38, "x_icr": 0.06, "alpha_left": 0.95, "alpha_right": 0.92}
ROBOT = Robot(track_width=0.6)
PERIOD_S = 0.05


def drive(
    seed,
    *,
    duration_s=80.0,
    noise_m=0.0,
    every=4,
    gyroscope=False,
    bias_rad_s=0.0,
    arm_m=(0.0, 0.0),
    most_turn=0.8,
    circle=False,
    name="run",
):
    """Tread speeds that hold for 2 s, the exact arcs of `ICR`, and an antenna at `arm_m`.

    On a circle they hold all the time.
    """
    rng = np.random.default_rng(seed)
    t = np.arange(0.0, duration_s, PERIOD_S)
    forward = np.repeat(rng.uniform(0.3, 1.0, len(t) // 40 + 1), 40)[: len(t)]
    turn = np.repeat(rng.uniform(-most_turn, most_turn, len(t) // 40 + 1), 40)[: len(t)]
    if circle:
        forward, turn = np.full(len(t), 0.6), np.full(len(t), 0.4)
    left, right = forward - 0.4 * turn, forward + 0.4 * turn
    path, omega = path_of(left, right)
    yaw = path[:, 2]
    c, s = np.cos(yaw), np.sin(yaw)
    antenna = path[:, :2] + np.column_stack(
        [c * arm_m[0] - s * arm_m[1], s * arm_m[0] + c * arm_m[1]]
    )
    antenna = antenna + noise_m * rng.standard_normal(antenna.shape)
    odometry = {"t": t, "v_left": left, "v_right": right}
    pose = {"t": t, "x": antenna[:, 0], "y": antenna[:, 1], "yaw": yaw}
    # A gyroscope reads its rate all along a step: at its middle, and the trapezoidal rule is exact
    # but for the steps in which the rate changes.
    imu = {"t": t + PERIOD_S / 2, "gyro_z": omega + bias_rad_s}
    settings = {"sensors": {"pose": [*map(float, arm_m), 0.0]}} if any(arm_m) else {}
    return Run(
        Path(name),
        ROBOT,
        settings,
        table(odometry),
        table({key: column[::every] for key, column in pose.items()}),
        imu=table(imu) if gyroscope else None,
    )


def path_of(left, right):
    """Poses (N, 3) before each step along exact arcs, and yaw rates (N,)."""
    left, right = left * ICR["alpha_left"], right * ICR["alpha_right"]
    width = ICR["y_left"] - ICR["y_right"]
    omega = (right - left) / width
    forward = (right * ICR["y_left"] - left * ICR["y_right"]) / width
    aside = -ICR["x_icr"] * omega
    half = omega * PERIOD_S / 2
    yaw = np.concatenate([[0.0], np.cumsum(2 * half[:-1])])
    chord = np.sinc(half / np.pi) * PERIOD_S
    c, s = np.cos(yaw + half), np.sin(yaw + half)
    steps = chord * np.array([c * forward - s * aside, s * forward + c * aside])
    places = np.pad(np.cumsum(steps[:, :-1], axis=1), ((0, 0), (1, 0)))
    return np.column_stack([*places, yaw]), omega


def emptied(run, *, turned_rad=0.0, moved_m=(0.0, 0.0)):
    """The run without yaw, its positions turned and moved in their frame."""
    c, s = np.cos(turned_rad), np.sin(turned_rad)
    x, y = run.pose["x"], run.pose["y"]
    columns = {
        **run.pose.columns,
        "x": c * x - s * y + moved_m[0],
        "y": s * x + c * y + moved_m[1],
        "yaw": np.full(len(x), np.nan),
    }
    return replace(run, pose=replace(run.pose, columns=columns))


def table(columns):
    return Table(Path("table.csv"), columns, np.arange(len(columns["t"])) + 2)


def slower(run, factor):
    """The same way in a longer time."""
    parts = {}
    for name in ("odometry", "pose"):
        columns = dict(getattr(run, name).columns)
        columns["t"] = columns["t"] * factor
        for speed in {"v_left", "v_right"} & set(columns):
            columns[speed] = columns[speed] / factor
        parts[name] = replace(getattr(run, name), columns=columns)
    return replace(run, **parts)
