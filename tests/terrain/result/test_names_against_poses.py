"""Poses that fit one terrain throughout better than those that the camera named."""

from types import SimpleNamespace

import numpy as np
import pytest

from terrain.result.names_against_poses import (
    NamesAgainstPoses,
    certainty_of,
    names_against_poses,
    names_note,
)
from tests.terrain.result.two_terrains import AT_S, two_terrains

OTHER = {"y_left": 0.6, "y_right": -0.57, "alpha_left": 0.9, "alpha_right": 0.9}


def named(names, wrong=OTHER, **keywords):
    """A drive on terrain `a`, with names that change every four seconds."""
    found = two_terrains(wrong, **keywords)
    found.replay.terrains = [names[int(s // 4) % len(names)] for s in AT_S]
    found.watcher = SimpleNamespace()
    return found


def test_wrong_names_are_worse_than_the_one_terrain_that_fits():
    found = names_against_poses(named("ab"))
    assert (found.terrain, found.is_worse) == ("a", True)
    assert found.named_m > 2 * found.alone_m
    (note,) = names_note(named("ab"))
    assert "--no-vision --terrain a" in note


def test_images_without_a_name_are_no_wrong_names():
    found = named("ab")
    found.replay.terrains = ["unknown" if name == "b" else name for name in found.replay.terrains]
    compared = names_against_poses(found)
    assert (compared.terrain, compared.named_m) == ("a", compared.alone_m)
    assert names_note(found) == []


@pytest.mark.parametrize("names", ["ab", "b", "a"])
def test_names_of_terrains_that_are_alike_are_not_worse(names):
    assert names_note(named(names, {})) == []


@pytest.mark.parametrize(
    ("named_m", "certainty", "is_worse"), [(0.3, 4.0, True), (0.3, 2.0, False), (0.21, 4.0, False)]
)
def test_names_are_worse_where_errors_are_surely_and_clearly_larger(named_m, certainty, is_worse):
    assert NamesAgainstPoses("a", 100, 10, named_m, 0.2, certainty).is_worse is is_worse


def test_few_stretches_or_poses_say_nothing():
    found = named("ab")
    found.replay.terrains = ["a"] * 800 + ["b"] * 800
    assert names_against_poses(found) is None
    assert names_against_poses(named("ab", yaw=False)) is None


def test_without_a_camera_nothing_is_said():
    found = named("ab")
    found.watcher = None
    assert names_note(found) == []


def test_turns_of_parameters_do_not_count_beside_a_gyroscope():
    """Without one a wrong width is an error of the way; the gyroscope turns the odometer right."""
    wide = {"y_left": 0.9, "y_right": -0.84}
    without = names_against_poses(named("ab", wide, sigma_m=0.0))
    beside = named("ab", wide, sigma_m=0.0)
    rates = {"gyro_z": np.zeros(len(AT_S))}
    odometry = beside.run.odometry
    beside.run = type(beside.run)(
        beside.run.folder,
        beside.run.robot,
        {},
        type(odometry)(odometry.file, {**odometry.columns, **rates}, odometry.lines),
        pose=beside.run.pose,
    )
    assert names_against_poses(beside).named_m < 0.5 * without.named_m


def test_the_deviation_is_that_of_the_means_of_stretches():
    """Of stretches of as many windows each, leaving one out gives the standard error of means."""
    differences = np.repeat([1.0, 2.0, 3.0], 4)
    stretches = np.repeat([5, 7, 9], 4)
    assert certainty_of(differences, stretches) == pytest.approx(2 / (1 / np.sqrt(3)))
