"""Tracks, sets and runs of modes, made by hand."""

from pathlib import Path

import numpy as np

from odometry.modes.follow.track import ModeTrack
from odometry.modes.models.mode_set import ModeSet
from odometry.modes.models.mode_set_file import MODE
from odometry.modes.models.traction import TractionModes
from odometry.modes.models.velocity import VelocityModes
from odometry.recording.run import Robot, Run
from odometry.tables.table import Table

STEP_S = 0.5


def track(most, labels, names=("a", "b", "c"), probability=0.95):
    """A stamp each half second; `most` is the probable mode, "" where all are equal."""
    count = len(names)
    rows = np.full((len(most), count), 1 / count)
    for row, name in enumerate(most):
        if name:
            rows[row] = (1 - probability) / (count - 1)
            rows[row, names.index(name)] = probability
    blank = np.zeros((len(most), 3))
    stamps_s = STEP_S * np.arange(len(most))
    squared = np.full(len(most), np.nan)
    labels = np.array(labels, dtype=object)
    return ModeTrack(names, stamps_s, rows, blank, blank + 0.1, squared, labels)


def velocity_set(turns=(1.0, 2.0), names=("ice", "tar"), sigma=0.05):
    """Modes that turn by so much per difference of tread speeds, at once; and their runs."""
    count = len(turns)
    A = np.tile(-500.0 * np.eye(2), (count, 1, 1))
    B = np.array([[[250.0, 250.0], [-500.0 * turn, 500.0 * turn]] for turn in turns])
    noise = np.full((count, 2), 1e-3), np.full((count, 2), sigma**2)
    return ModeSet(VelocityModes(names, A, B, *noise), np.full(count, 20.0), "by hand")


def traction_set(turns=(0.5, 0.8), names=("none", "all")):
    """Modes that turn by so much of what was requested."""
    (shape,) = (one.shape for one in MODE["traction"] if one.name == "gains")
    gains = np.zeros((len(turns), *shape))
    gains[:, :, 0, 0] = 1.0
    gains[:, :, 2, 1] = np.array(turns)[:, None]
    modes = TractionModes(
        names=names,
        gains=gains,
        lag_s=np.zeros(len(turns)),
        track_width=0.5,
        process_variance=np.array([1e-4, 1e-4, 1e-8]),
        measurement_variance=np.array([4e-4, 4e-4, 1e-4, 1e-3]),
    )
    return ModeSet(modes, np.full(len(turns), 20.0), "by hand")


def run_of(turn, *, track_width=1.0, size=400, labels=None, rng=None, folder="drive"):
    """A run that weaves: yaw rate = turn times the difference of treads (N,), at 50 Hz."""
    t = 0.02 * np.arange(size)
    half = 0.3 * np.sin(2 * np.pi * t / 6)
    rng = rng or np.random.default_rng(5)
    omega = np.broadcast_to(turn, t.shape) * 2 * half / track_width
    yaw = np.append(0.0, np.cumsum(omega[:-1]) * 0.02)
    x, y = (np.append(0.0, np.cumsum(0.5 * f(yaw[:-1])) * 0.02) for f in (np.cos, np.sin))
    odometry = {"t": t, "v_left": 0.5 - half, "v_right": 0.5 + half}
    turning = np.append(omega[0], omega[:-1])  # until the stamp
    odometry["gyro_z"] = turning + 0.02 * rng.standard_normal(size)
    if labels is not None:
        odometry["terrain"] = np.array(labels)
    noise = 0.01 * rng.standard_normal((3, size))
    poses = dict(zip(("t", "x", "y", "yaw"), (t, x, y, yaw), strict=True))
    pose = {name: column[::5] for name, column in poses.items()}
    pose |= {name: pose[name] + noise[i, ::5] for i, name in enumerate(("x", "y", "yaw"))}
    tables = [Table(Path("t.csv"), c, np.arange(len(c["t"])) + 2) for c in (odometry, pose)]
    return Run(Path(folder), Robot(track_width, length=0.8), {}, *tables)


def positions_that_determine_no_yaw(run):
    """Columns of pose.csv without yaw: positions whose noise is larger than the drive."""
    columns = dict(run.pose.columns)
    for axis, name in enumerate(("x", "y")):
        columns[name] = columns[name] + 9.0 * np.random.default_rng(axis).normal(size=len(run.pose))
    return columns | {"yaw": np.full(len(run.pose), np.nan)}
