"""Parameters of terrains that a gyroscope contradicts, where no yaw was measured."""

from dataclasses import replace
from types import SimpleNamespace

import numpy as np
import pytest

from odometry.models.catalogue import MODELS
from odometry.models.inputs import Inputs
from odometry.parameters import ParameterSet, TerrainParameters
from terrain.result.run_notes import run_notes
from terrain.result.sets_against_gyroscope import sets_against_gyroscope
from terrain.result.sets_against_poses import sentences
from tests.terrain.result.two_terrains import AT_S, RIGHT, table, two_terrains


def driven(wrong, *, scale=1.0, bias_rad_s=0.0, turns=1.0, poses=False):
    """The drive of the other tests with a gyroscope; with or without positions."""
    of = two_terrains(wrong, yaw=False)
    speeds = of.run.odometry.stack("v_left", "v_right")
    mean = speeds.mean(axis=1)
    speeds = mean[:, None] + turns * (speeds - mean[:, None])
    model = MODELS["icr"]
    turn_rad_s = model.twist(model.pack(RIGHT), Inputs(speeds))[:, 2]
    noise = np.random.default_rng(4).normal(0, 0.01, len(AT_S))
    gyro_z = scale * turn_rad_s + bias_rad_s + noise
    odometry = table(t=AT_S, v_left=speeds[:, 0], v_right=speeds[:, 1], gyro_z=gyro_z)
    of.run = replace(of.run, odometry=odometry, pose=of.run.pose if poses else None)
    return of


def said(of):
    return sentences(sets_against_gyroscope(of))


@pytest.mark.parametrize("bias_rad_s", [0.0, 0.02])
def test_parameters_that_fit_are_not_contradicted(bias_rad_s):
    found = sets_against_gyroscope(driven({}, bias_rad_s=bias_rad_s))
    assert [one.terrain for one in found] == ["a", "b"]
    assert all(np.isnan(one.ratios.turn) or abs(one.ratios.turn - 1) < 0.1 for one in found)
    assert said(driven({}, bias_rad_s=bias_rad_s)) == []
    assert said(driven({"y_left": 0.5, "y_right": -0.47})) == []


@pytest.mark.parametrize("poses", [False, True])
@pytest.mark.parametrize("bias_rad_s", [0.0, 0.02])
def test_a_width_of_another_terrain_is_named(poses, bias_rad_s):
    of = driven({"y_left": 0.9, "y_right": -0.84}, poses=poses, bias_rad_s=bias_rad_s)
    (sentence,) = said(of)
    assert "by the gyroscope the robot turned" in sentence
    assert sets_against_gyroscope(of)[1].ratios.turn == pytest.approx(2.0, abs=0.1)
    assert "'b'" in sentence
    assert "Learn them with identify" in sentence


def test_turns_that_a_bias_would_explain_are_not_named():
    """Nearly straight: what the gyroscope turns is its bias."""
    assert said(driven({}, turns=0.15, bias_rad_s=0.05)) == []


def test_a_drive_that_turns_evenly_is_not_named_for_what_cannot_be_told():
    """On one circle at one speed a bias cannot be told from turns."""
    of = driven({})
    speeds = np.tile([0.4, 0.6], (len(AT_S), 1))
    gyro_z = np.full(len(AT_S), 0.2 / 0.87)
    odometry = table(t=AT_S, v_left=speeds[:, 0], v_right=speeds[:, 1], gyro_z=gyro_z)
    of.run = replace(of.run, odometry=odometry)
    assert said(of) == []


@pytest.mark.parametrize("scale", [180 / np.pi, -1.0])
def test_another_unit_or_sign_of_the_gyroscope_is_not_a_terrain(scale):
    assert said(driven({}, scale=scale)) == []


def test_without_a_gyroscope_nothing_is_compared():
    assert sets_against_gyroscope(two_terrains({"y_left": 0.9}, yaw=False)) == []


def test_run_notes_hold_it_where_no_yaw_was_measured():
    of = driven({"y_left": 0.9, "y_right": -0.84})
    rest = SimpleNamespace(
        **vars(of), initial_terrain="a", watcher=None, source="labels", contradictions=()
    )
    rest.replay.innovations_squared = np.full(len(AT_S), np.nan)
    rest.replay.accepted = np.zeros(len(AT_S), dtype=bool)
    rest.parameters = ParameterSet(of.parameters.terrains)
    assert any("by the gyroscope" in note for note in run_notes(rest))


def test_terrains_that_were_not_in_force_are_left_out():
    of = driven({})
    of.parameters = ParameterSet({"c": TerrainParameters("icr", RIGHT)})
    assert sets_against_gyroscope(of) == []
