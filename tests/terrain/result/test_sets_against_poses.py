"""Parameters of terrains that poses contradict."""

from dataclasses import replace
from pathlib import Path
from types import SimpleNamespace

import numpy as np
import pytest

from odometry.models.catalogue import MODELS
from odometry.models.inputs import Inputs
from odometry.parameters import ParameterSet, TerrainParameters
from odometry.run import Robot, Run
from odometry.table import Table
from odometry.windows.travel.motion import level_path
from odometry.windows.travel.motion_ratios import MotionRatios
from terrain.result.sets_against_poses import sentences, sets_against_poses

RIGHT = {"y_left": 0.45, "y_right": -0.42, "x_icr": -0.05}
AT_S = 0.05 * np.arange(1600)


def table(**columns):
    return Table(Path("a.csv"), columns, np.arange(len(AT_S)) + 2)


def result(wrong, *, scale=1.0, sigma_m=0.01, yaw=True):
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


@pytest.mark.parametrize("sigma_m", [0.0, 0.01, 0.1])
def test_parameters_that_fit_are_not_contradicted(sigma_m):
    found = sets_against_poses(result({}, sigma_m=sigma_m))
    assert [one.terrain for one in found] == ["a", "b"]
    assert sentences(found) == []
    assert sentences(sets_against_poses(result({"y_left": 0.5, "y_right": -0.47}))) == []


def test_a_width_of_another_terrain_is_named():
    found = sets_against_poses(result({"y_left": 0.9, "y_right": -0.84}))
    (sentence,) = sentences(found)
    assert found[1].ratios.turn == pytest.approx(2.0, abs=0.05)
    assert "turned 2.0" in sentence
    assert "'b'" in sentence


def test_one_factor_on_all_terrains_is_of_the_treads():
    (sentence,) = sentences(sets_against_poses(result({}, scale=0.8)))
    assert "went 0.80 to 0.8" in sentence
    assert "wheel radius" in sentence


def test_without_yaw_or_poses_nothing_is_compared():
    assert sets_against_poses(result({"y_left": 0.9}, yaw=False)) == []
    without = result({"y_left": 0.9})
    without.run = replace(without.run, pose=None)
    assert sets_against_poses(without) == []


@pytest.mark.parametrize(
    ("ratio", "said"), [(0.78, True), (0.82, False), (1.22, False), (1.28, True)]
)
def test_a_quarter_more_is_as_far_as_one_over_it(ratio, said):
    assert MotionRatios(ratio, 0.02, 1.0, 0.01).turns_otherwise is said
    assert MotionRatios(np.nan, np.nan, 1.0, 0.01).turns_otherwise is False
