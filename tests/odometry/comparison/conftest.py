"""Run folders of a robot whose ICRs are known, driven by a plain loop."""

import math
from types import SimpleNamespace

import numpy as np
import pytest

from odometry.comparison.config import ComparisonConfig
from odometry.identification.start import SolverConfig
from odometry.io.run_folder import write_run_folder
from odometry.parameters import ParameterSet, TerrainParameters, write_parameters
from odometry.recording.run import Run

SYMMETRIC = {"y_left": 0.4, "y_right": -0.4, "x_icr": 0.0, "alpha_left": 1.0, "alpha_right": 1.0}
SKEWED = {"y_left": 0.5, "y_right": -0.3, "x_icr": 0.1, "alpha_left": 0.95, "alpha_right": 0.9}
STEP_S = 0.05
TRACK_WIDTH = 0.5


def advance(pose, v_left, v_right, icrs, seconds):
    """The pose after a time at given tread speeds, in a thousand small straight steps a second."""
    x, y, yaw = pose
    left, right = icrs["alpha_left"] * v_left, icrs["alpha_right"] * v_right
    width = icrs["y_left"] - icrs["y_right"]
    omega = (right - left) / width
    v_x = (right * icrs["y_left"] - left * icrs["y_right"]) / width
    v_y = -icrs["x_icr"] * omega
    count = max(1, round(seconds * 1000))
    for _ in range(count):
        middle = yaw + omega * seconds / count / 2
        x += (math.cos(middle) * v_x - math.sin(middle) * v_y) * seconds / count
        y += (math.sin(middle) * v_x + math.cos(middle) * v_y) * seconds / count
        yaw += omega * seconds / count
    return x, y, yaw


def varied(rng, seconds):
    """Tread speeds (N, 2) at 20 Hz that change every two seconds, spins among them."""
    count = round(seconds / STEP_S)
    changes = rng.uniform(-1.0, 1.4, (-(-count // 40), 2))
    return np.repeat(changes, 40, axis=0)[:count]


def write(
    folder,
    speeds,
    *,
    seed=0,
    icrs=SYMMETRIC,
    noise_m=0.005,
    terrain="grass",
    robot=None,
    terrain_column=None,
    window_s=None,
    gap_s=None,
):
    """Write a run folder; poses at 10 Hz with noise, none within `gap_s`."""
    rng = np.random.default_rng(seed)
    stamps_s = STEP_S * np.arange(len(speeds))
    poses = [(1.0, -2.0, 0.3)]
    for v_left, v_right in speeds[:-1]:
        poses.append(advance(poses[-1], v_left, v_right, icrs, STEP_S))
    kept = np.arange(len(speeds)) % 2 == 0
    if gap_s is not None:
        kept &= (stamps_s <= gap_s[0]) | (stamps_s >= gap_s[1])
    measured = np.array(poses)[kept] + rng.normal(
        0, [noise_m, noise_m, noise_m / 2], (kept.sum(), 3)
    )
    pose = {"t": stamps_s[kept], "x": measured[:, 0], "y": measured[:, 1]}
    pose["yaw"] = np.arctan2(np.sin(measured[:, 2]), np.cos(measured[:, 2]))
    if window_s is not None:
        pose["window"] = np.floor(stamps_s[kept] / window_s)
    odometry = {"t": stamps_s, "v_left": speeds[:, 0], "v_right": speeds[:, 1]}
    if terrain_column is not None:
        odometry["terrain"] = np.array(terrain_column)
    settings = {"robot": robot or {"name": "rover", "track_width": TRACK_WIDTH}}
    if terrain is not None:
        settings["run"] = {"terrain": terrain}
    write_run_folder(folder, settings, {"odometry": odometry, "pose": pose})
    return folder


def write_set(file, model, values, terrain="grass", **more):
    """Write a parameter set of one terrain; its file name as a candidate."""
    write_parameters(file, ParameterSet({terrain: TerrainParameters(model, values, **more)}))
    return str(file)


@pytest.fixture(scope="session")
def bench():
    """The functions and numbers above."""
    return SimpleNamespace(
        advance=advance,
        skewed=SKEWED,
        step_s=STEP_S,
        symmetric=SYMMETRIC,
        track_width=TRACK_WIDTH,
        varied=varied,
        width={"alpha": 1.0, "b_hat": 0.8},
        write=write,
        write_set=write_set,
    )


@pytest.fixture(scope="session")
def grass(tmp_path_factory):
    """Three runs of a symmetric robot on grass."""
    folder = tmp_path_factory.mktemp("grass")
    return [
        Run.read(write(folder / f"run_{i}", varied(np.random.default_rng(i), 40.0), seed=i))
        for i in range(3)
    ]


@pytest.fixture(scope="session")
def quick():
    """One start and few draws."""
    return ComparisonConfig(solver=SolverConfig(starts=1), draws=400)
