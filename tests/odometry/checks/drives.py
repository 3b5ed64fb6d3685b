"""Made recordings of robots that drive, without a fault."""

from dataclasses import replace
from pathlib import Path

import numpy as np

from odometry.recording.run import Robot, Run
from odometry.tables.table import Table
from tests.odometry.checks.faulty import put, without_yaw

PERIOD_S = 0.05


WIDTH_M = 0.9  # effective, of a track width of 0.6 m


def table(file, **columns):
    return Table(Path(file), columns, np.arange(2, 2 + len(columns["t"])))


def drive(speed_m_s, turn_rad_s, *, yaw_sigma=0.01, sigma_m=0.02, seed=0):
    """A recording of a twist (N,) at 20 Hz with poses at 10 Hz."""
    rng = np.random.default_rng(seed)
    stamps = PERIOD_S * np.arange(len(speed_m_s))
    yaw = np.cumsum(turn_rad_s) * PERIOD_S
    x, y = (np.cumsum(speed_m_s * f(yaw)) * PERIOD_S for f in (np.cos, np.sin))
    slip = 1 + 0.01 * rng.standard_normal((2, len(stamps)))
    left, right = (
        (speed_m_s + side * turn_rad_s * WIDTH_M / 2) / 0.93 * noise
        for side, noise in zip((-1, 1), slip, strict=True)
    )
    noise = rng.standard_normal((3, len(stamps[::2])))
    pose = table(
        "pose.csv",
        t=stamps[::2],
        x=x[::2] + sigma_m * noise[0],
        y=y[::2] + sigma_m * noise[1],
        yaw=np.angle(np.exp(1j * (yaw[::2] + yaw_sigma * noise[2]))),
    )
    gyro = turn_rad_s + 0.003 * rng.standard_normal(len(stamps))
    odometry = table("odometry.csv", t=stamps, v_left=left, v_right=right, gyro_z=gyro)
    return Run(Path("somewhere"), Robot(track_width=0.6), {}, odometry, pose)


def winding(count=2400):
    at_s = PERIOD_S * np.arange(count)
    return drive(1 + 0.3 * np.sin(at_s / 7), 0.5 * np.sin(at_s / 3) + 0.2 * np.sin(at_s / 1.3))


def turning_all_round(seed=0):
    at_s = 0.05 * np.arange(4000)
    turn = 0.35 * np.sin(at_s / 9) + 0.25 * np.sin(at_s / 2.3) + 0.12
    return drive(0.8 + 0.3 * np.sin(at_s / 5), turn, seed=seed)


def uneven(seed=0):
    """A drive whose speed and turns change all the time."""
    rng = np.random.default_rng(seed)
    at_s = 0.05 * np.arange(4000)
    lengths_s, phases = rng.uniform(2, 9, 8), rng.uniform(0, 6, 8)
    waves = [np.sin(at_s / s + p) for s, p in zip(lengths_s, phases, strict=True)]
    return drive(0.6 + 0.2 * sum(waves[:4]), 0.3 * sum(waves[4:]), seed=seed)


def stepping(seed=0, yaw_sigma=0.01):
    """Turns and speeds that change at random moments, within a third of a second."""
    rng = np.random.default_rng(seed)
    count = 3200
    turns, speeds = (
        np.repeat(rng.uniform(least, most, 80), 40)[:count]
        for least, most in ((-0.8, 0.8), (0.3, 1.2))
    )
    ramp = np.ones(7) / 7
    smooth = [np.convolve(values, ramp, mode="same") for values in (speeds, turns)]
    return drive(*smooth, yaw_sigma=yaw_sigma, seed=seed)


def to_and_fro(seed=0):
    """Forwards, backwards and on the spot, at speeds that change."""
    at_s = 0.05 * np.arange(4000)
    speed = 0.8 * np.sin(at_s / 5) + 0.3 * np.sin(at_s / 1.7)
    return drive(speed, 0.5 * np.sin(at_s / 3.1) + 0.4 * np.sin(at_s / 1.1), seed=seed)


def varied(seed=0):
    """A drive of stops, straights and turns, which no shift imitates."""
    at_s = 0.05 * np.arange(4000)
    speed = 0.6 + 0.5 * np.sin(at_s / 4) + 0.2 * np.sin(at_s / 1.1)
    turn = 0.35 * np.sin(at_s / 5.7) + 0.3 * np.sin(at_s / 1.7) + 0.1
    rest = (at_s < 2) | (at_s > at_s[-1] - 2)
    return drive(np.where(rest, 0.0, speed), np.where(rest, 0.0, turn), seed=seed)


AT_REST_S = (100.0, 112.0)


def pausing(seed=0):
    """A drive that stands still for a while in its midst."""
    at_s = 0.05 * np.arange(4000)
    goes = (at_s < AT_REST_S[0]) | (at_s > AT_REST_S[1])
    turn = 0.35 * np.sin(at_s / 5.7) + 0.3 * np.sin(at_s / 1.7) + 0.1
    return drive((0.7 + 0.3 * np.sin(at_s / 4)) * goes, turn * goes, seed=seed)


def driven(seed=0):
    """Speeds and turns that change all the time, so that both have a delay."""
    rng = np.random.default_rng(seed)
    speed, turn = (
        np.convolve(rng.standard_normal(4400), np.hanning(60), "same")[:4000] for _ in range(2)
    )
    return drive(0.9 + 0.06 * speed, 0.08 * turn, seed=seed)


def starts_and_stops(delay_s, hz, sigma_m, seed=0):
    """A drive of changing speed, with positions of a receiver that are late."""
    at_s, rng = 0.05 * np.arange(4000), np.random.default_rng(seed)
    phases = rng.uniform(0, 6, 4)
    speed = sum(np.sin(at_s / s + p) for s, p in zip((1.5, 3, 5, 8), phases, strict=True))
    run = drive(np.maximum(0.5 + 0.4 * speed, 0), 0.3 * np.sin(at_s / 4))
    every = slice(None, None, round(1 / hz / float(np.median(np.diff(run.pose.stamps_s)))))
    run = replace(run, pose=run.pose.rows(every))
    noise = rng.normal(scale=sigma_m, size=(2, len(run.pose)))
    moved = put(run, "pose", x=run.pose["x"] + noise[0], y=run.pose["y"] + noise[1])
    return without_yaw(put(moved, "pose", t=moved.pose["t"] + delay_s))


def shunting(seed=0):
    """Stretches of four seconds: at rest, backwards, slow and fast, with turns of any size."""
    rng = np.random.default_rng(seed)
    speeds = rng.choice([0.0, -0.5, 0.6, 0.9], 40, p=[0.2, 0.1, 0.4, 0.3])
    turns, ramp = rng.uniform(-0.5, 0.5, 40), np.ones(20) / 20
    return drive(*(np.convolve(np.repeat(v, 80), ramp, "same") for v in (speeds, turns)), seed=seed)
