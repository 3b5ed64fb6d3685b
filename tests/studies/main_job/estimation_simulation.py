"""A drive simulated by its own loop: ICRs that are true, and noise as a filter assumes it.

Speeds hold over a step; the pose moves along the exact arc. Nothing here is of the project but
the containers `Frame`, `Run` and `Table`.
"""

import math
from dataclasses import dataclass
from pathlib import Path as Folder

import numpy as np

from odometry.recording.frames import Frame
from odometry.recording.run import Robot, Run
from odometry.tables.table import Table

TRACK_WIDTH_M = 0.6
STEP_S = 0.05


@dataclass(frozen=True)
class Noise:
    """Standard deviations: of the motion per root of a second, of slip in metres per root of a
    metre of wheel travel (yaw: by the track width), of poses and treads per sample."""

    position: float = 0.0
    yaw: float = 0.0
    slip: float = 0.0
    icr_m: float = 0.0
    alpha: float = 0.0
    gyro: float = 0.0
    bias: float = 0.0
    pose_m: float = 0.0
    pose_rad: float = 0.0
    tread_m_s: float = 0.0


@dataclass(frozen=True)
class Drive:
    """Truth and measurements at N stamps; poses are NaN where none is measured.

    Attributes
    ----------
    states : (N, 9)
        x, y, yaw, y_left, y_right, x_icr, bias of the gyroscope, slip factors left and right.
    """

    stamps_s: np.ndarray
    speeds_m_s: np.ndarray
    states: np.ndarray
    poses: np.ndarray
    yaw_rates: np.ndarray


def drive(speeds, start, noise, rng, *, pose_every=4):
    """Drive tread speeds (N, 2) from a state whose parameters wander.

    `start` is a state (9,), or ICRs (3,) alone: then there is no slip, and no bias. The yaw rate
    is the mean since the frame before.
    """
    if len(start) == 3:
        start = [0.0, 0.0, 0.0, *start, 0.0, 1.0, 1.0]
    state, root = np.array(start, dtype=float), math.sqrt(STEP_S)
    walk = [noise.position] * 2 + [noise.yaw] + [noise.icr_m] * 3 + [noise.bias] + [noise.alpha] * 2
    slips = np.array([1.0, 1.0, 1.0 / TRACK_WIDTH_M, *[0.0] * 6]) * noise.slip
    states, rates = [state], [math.nan]
    for pair in speeds[:-1]:
        before, travel = state[2], np.abs(pair).mean() * STEP_S
        wander = np.sqrt(np.square(walk) * STEP_S + np.square(slips) * travel)
        state = _moved(state, *pair, STEP_S) + wander * rng.normal(0, 1, 9)
        rates.append((state[2] - before) / STEP_S + state[6] + noise.gyro / root * rng.normal())
        states.append(state)
    states, stamps = np.array(states), np.arange(len(speeds)) * STEP_S
    sigma = [noise.pose_m, noise.pose_m, noise.pose_rad]
    poses = states[:, :3] + sigma * rng.normal(0, 1, (len(states), 3))
    poses[np.arange(len(poses)) % pose_every != 0] = np.nan
    measured = speeds + rng.normal(0, 1, speeds.shape) * noise.tread_m_s
    return Drive(stamps, measured, states, poses, np.array(rates))


def _moved(state, left, right, step_s):
    x, y, yaw, y_left, y_right, x_icr, _, alpha_left, alpha_right = state
    left, right = alpha_left * left, alpha_right * right
    rate = (right - left) / (y_left - y_right)
    ahead = (right * y_left - left * y_right) / (y_left - y_right) * step_s
    aside, turn = -x_icr * rate * step_s, rate * step_s
    chord = np.sinc(turn / 2 / math.pi)
    cosine, sine = math.cos(yaw + turn / 2) * chord, math.sin(yaw + turn / 2) * chord
    place = [x + cosine * ahead - sine * aside, y + sine * ahead + cosine * aside, yaw + turn]
    return np.array([*place, *state[3:]])


def weave(duration_s, rng, speed_m_s=0.8):
    """Tread speeds (N, 2): a steady speed, and turns to both sides of random strength."""
    t = np.arange(0, duration_s, STEP_S)
    phases = rng.uniform(0, 7, 3)
    half = sum(
        0.12 * np.sin(2 * np.pi * t / period + phase)
        for period, phase in zip((7.0, 11.0, 17.0), phases, strict=True)
    )
    return np.stack([speed_m_s - half, speed_m_s + half], axis=-1) * np.clip(t / 2, 0, 1)[:, None]


def loop(length_m, icrs, speed_m_s=1.0):
    """Tread speeds (N, 2) of a closed loop with bends to both sides, driven with those ICRs."""
    t = np.arange(0, length_m / speed_m_s, STEP_S)
    share = t / t[-1]
    rate = 2 * np.pi / t[-1] * (1 + 4.0 * np.cos(2 * np.pi * 8 * share))
    y_left, y_right, _ = icrs
    speeds = np.stack([speed_m_s - y_left * rate, speed_m_s - y_right * rate], axis=-1)
    return speeds * np.clip(np.minimum(t, t[-1] - t) / 2, 0, 1)[:, None]


def frames_of(one, *, gyroscope):
    """The drive as frames."""
    for row, stamp_s in enumerate(one.stamps_s):
        pose = one.poses[row]
        yield Frame(
            stamp_s=float(stamp_s),
            tread_speeds_m_s=one.speeds_m_s[row],
            odometry_row=row,
            pose=None if np.isnan(pose).all() else pose,
            image=None,
            yaw_rate_rad_s=float(one.yaw_rates[row]) if gyroscope else math.nan,
        )


def run_of(one, *, gyroscope):
    """The drive as a run that was never a folder; its gyroscope is sampled between stamps."""
    folder, rows = Folder("simulated"), np.arange(2, len(one.stamps_s) + 2)
    columns = {"t": one.stamps_s, "v_left": one.speeds_m_s[:, 0], "v_right": one.speeds_m_s[:, 1]}
    odometry = Table(folder / "odometry.csv", columns, rows)
    measured = np.isfinite(one.poses).any(axis=1)
    x, y, yaw = one.poses[measured].T
    columns = {"t": one.stamps_s[measured], "x": x, "y": y, "yaw": yaw}
    pose = Table(folder / "pose.csv", columns, rows[measured])
    imu = None
    if gyroscope:
        columns = {"t": one.stamps_s[1:] - STEP_S / 2, "gyro_z": one.yaw_rates[1:]}
        imu = Table(folder / "imu.csv", columns, rows[1:])
    settings = {"robot": {"track_width": TRACK_WIDTH_M}}
    return Run(folder, Robot(TRACK_WIDTH_M), settings, odometry, pose=pose, imu=imu)
