"""The result of a drive on two terrains, of which only the parameters matter."""

from pathlib import Path
from types import SimpleNamespace

import numpy as np

from odometry.models.catalogue import MODELS
from odometry.models.inputs import Inputs
from odometry.parameters import ParameterSet, TerrainParameters
from odometry.recording.run import Robot, Run
from odometry.tables.table import Table
from odometry.windows.travel.motion import level_path

RIGHT = {"y_left": 0.45, "y_right": -0.42, "x_icr": -0.05}
AT_S = 0.05 * np.arange(1600)


def table(**columns):
    return Table(Path("a.csv"), columns, np.arange(len(AT_S)) + 2)


def two_terrains(wrong, *, scale=1.0, sigma_m=0.01, yaw=True):
    """A drive on two terrains whose ICRs are the same; the parameters of `b` are others."""
    rng = np.random.default_rng(2)
    speeds = 0.5 + 0.3 * np.stack([np.sin(AT_S / 3), np.sin(AT_S / 4.3 + 1)], axis=-1)
    inputs = Inputs(scale * speeds)
    model = MODELS["icr"]
    twists = model.twist(model.pack(RIGHT), inputs)
    poses = level_path(twists, np.full(len(AT_S), 0.05), inputs)
    noisy = poses + rng.normal(0, sigma_m, poses.shape) * [1, 1, 0.5]
    run = Run(
        Path("drive"),
        Robot(track_width=0.5),
        {},
        table(t=AT_S, v_left=speeds[:, 0], v_right=speeds[:, 1]),
        pose=table(t=AT_S, x=noisy[:, 0], y=noisy[:, 1], yaw=noisy[:, 2] if yaw else AT_S * np.nan),
    )
    names = ["a"] * 800 + ["b"] * 800
    sets = {"a": TerrainParameters("icr", RIGHT), "b": TerrainParameters("icr", {**RIGHT, **wrong})}
    return SimpleNamespace(
        run=run,
        replay=SimpleNamespace(stamps_s=AT_S, terrains=names),
        parameters=ParameterSet(sets),
    )
