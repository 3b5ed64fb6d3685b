"""Parameters of terrains that poses contradict."""

from dataclasses import replace

import numpy as np
import pytest

from odometry.windows.travel.motion_ratios import MotionRatios
from terrain.result.sets_against_poses import sentences, sets_against_poses
from tests.terrain.result.two_terrains import two_terrains


@pytest.mark.parametrize("sigma_m", [0.0, 0.01, 0.1])
def test_parameters_that_fit_are_not_contradicted(sigma_m):
    found = sets_against_poses(two_terrains({}, sigma_m=sigma_m))
    assert [one.terrain for one in found] == ["a", "b"]
    assert sentences(found) == []
    assert sentences(sets_against_poses(two_terrains({"y_left": 0.5, "y_right": -0.47}))) == []


def test_a_width_of_another_terrain_is_named():
    found = sets_against_poses(two_terrains({"y_left": 0.9, "y_right": -0.84}))
    (sentence,) = sentences(found)
    assert found[1].ratios.turn == pytest.approx(2.0, abs=0.05)
    assert "turned 2.0" in sentence
    assert "'b'" in sentence


def test_one_factor_on_all_terrains_is_of_the_treads():
    (sentence,) = sentences(sets_against_poses(two_terrains({}, scale=0.8)))
    assert "went 0.80 to 0.8" in sentence
    assert "wheel radius" in sentence


def test_without_yaw_or_poses_nothing_is_compared():
    assert sets_against_poses(two_terrains({"y_left": 0.9}, yaw=False)) == []
    without = two_terrains({"y_left": 0.9})
    without.run = replace(without.run, pose=None)
    assert sets_against_poses(without) == []


@pytest.mark.parametrize(
    ("ratio", "said"), [(0.78, True), (0.82, False), (1.22, False), (1.28, True)]
)
def test_a_quarter_more_is_as_far_as_one_over_it(ratio, said):
    assert MotionRatios(ratio, 0.02, 1.0, 0.01).turns_otherwise is said
    assert MotionRatios(np.nan, np.nan, 1.0, 0.01).turns_otherwise is False
