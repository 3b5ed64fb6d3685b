"""Maps as candidates, and a change that may be another terrain as it began at new places."""

from dataclasses import replace
from types import SimpleNamespace

import numpy as np
import pytest

from odometry.effects.commands.wheel_scale import WheelScale
from odometry.effects.interface.corrected import Added
from odometry.effects.interface.in_course import in_course
from odometry.effects.interface.time_course import FromAMoment, InBursts
from odometry.effects.motion.traction_loss import TractionLoss
from odometry.gap.answer.new_places import terrain_instead
from odometry.gap.answer.result import Equivalent
from odometry.gap.config import GapConfig
from odometry.gap.name.events_at_places import chance_of_places
from odometry.gap.name.places import finer_maps, maps
from odometry.models.inputs import Inputs

CONFIG = GapConfig()
TIME_S = np.arange(0.0, 120.0, 0.1)


def along(path):
    """A scene of poses alone, at positions of time."""
    positions_m = np.column_stack(path(TIME_S))
    poses = np.column_stack([positions_m, np.zeros(len(TIME_S))])
    inputs = SimpleNamespace(position_m=positions_m)
    return SimpleNamespace(inputs=inputs, time_s=TIME_S, pose_s=TIME_S, poses=poses)


def circle(t):
    return 3.0 * np.cos(t / 5), 3.0 * np.sin(t / 5)


def straight(t):
    return 0.5 * t, np.zeros_like(t)


def test_maps_cover_where_the_robot_was_with_as_many_nodes_as_they_may():
    found = maps([along(circle)], CONFIG)
    assert {len(one.nodes) <= most for one in found for most in (max(CONFIG.nodes),)} == {True}
    assert len({one.spacing_m for one in found}) == len(CONFIG.nodes)
    assert len({one.key for one in found}) == len(found)
    inputs = along(circle).inputs
    for one in found:
        assert one.hats(inputs.position_m).sum(axis=1).min() > 0.4
        components = {component for component, _ in one.terms}
        assert len(one.terms) == len(components) * len(one.nodes)


def test_finer_maps_are_of_each_axis_alone_and_resolve_less_than_a_metre():
    coarse, finer = (make([along(circle)], CONFIG) for make in (maps, finer_maps))
    assert {one.axis for one in coarse} == {""}
    assert {one.axis for one in finer} == {"", "x", "y"}
    assert len({one.key for one in (*coarse, *finer)}) == len(coarse) + len(finer)
    for one in finer:
        assert one.spacing_m < min(of.spacing_m for of in coarse)
        assert not one.axis or {node["yx".index(one.axis)] for node in one.nodes} == {0}


def test_a_robot_that_never_comes_back_has_no_map():
    assert maps([along(straight)], CONFIG) == ()
    assert maps([along(straight)], replace(CONFIG, least_revisited=0.0))


def test_a_robot_that_turns_on_the_spot_has_no_map():
    assert maps([along(lambda t: (0.01 * np.cos(t), 0.01 * np.sin(t)))], CONFIG) == ()


def test_without_positions_there_is_no_map():
    scene = SimpleNamespace(inputs=SimpleNamespace(position_m=None))
    assert maps([along(circle), scene], CONFIG) == ()


def from_a_moment(moment_s, inner=TractionLoss, values=(0.8, 0.9)):
    effect = in_course(inner(), FromAMoment(((0.0, 120.0),)))
    return Added(effect, np.array([*values, moment_s]))


@pytest.mark.parametrize("inner", [TractionLoss, WheelScale])
def test_a_change_at_new_places_alone_may_be_another_terrain(inner):
    added = from_a_moment(60.0, inner)
    (one,) = terrain_instead([added], (), [along(straight)])
    assert (one.name, one.instead_of) == ("terrain", added.effect.name)
    assert "drive back" in one.told_apart_by


def test_where_the_robot_comes_back_it_is_none():
    assert terrain_instead([from_a_moment(60.0)], (), [along(circle)]) == ()


def test_every_run_must_be_at_new_places():
    two = in_course(TractionLoss(), FromAMoment(((0.0, 120.0),) * 2))
    added = Added(two, np.array([0.8, 0.9, 60.0, 60.0]))
    assert terrain_instead([added], (), [along(straight), along(circle)]) == ()
    assert terrain_instead([added], (), [along(straight), along(straight)])


def test_an_effect_without_a_moment_or_a_terrain_that_is_there_already_adds_nothing():
    always = Added(TractionLoss(), np.array([0.8, 0.9]))
    assert terrain_instead([always], (), [along(straight)]) == ()
    there = (Equivalent("terrain", "traction_loss", "a drive"),)
    assert terrain_instead([from_a_moment(60.0)], there, [along(straight)]) == ()


def rounds(events_s):
    """A robot on a circle that it closes in 31.4 s, with events."""
    scene = along(circle)
    inputs = Inputs(np.zeros((len(TIME_S), 2)), time_s=TIME_S, position_m=scene.inputs.position_m)
    return InBursts((tuple(events_s),)), replace_inputs(scene, inputs)


def replace_inputs(scene, inputs):
    return SimpleNamespace(**{**vars(scene), "inputs": inputs})


def test_events_at_one_place_of_each_round_are_no_chance():
    round_s = 10 * np.pi
    course, scene = rounds([(4.0 + k * round_s, 7.0 + k * round_s) for k in range(3)])
    assert chance_of_places(course, [scene], CONFIG) < CONFIG.by_place


def test_events_at_other_places_each_time_are():
    course, scene = rounds([(4.0, 7.0), (48.0, 51.0), (88.0, 91.0), (102.0, 105.0)])
    assert chance_of_places(course, [scene], CONFIG) > 0.1


def test_where_no_place_is_visited_twice_nothing_is_known_of_places():
    _, scene = rounds([])
    straight_m = np.column_stack(straight(TIME_S))
    inputs = replace(scene.inputs, position_m=straight_m)
    course = InBursts((((4.0, 7.0), (30.0, 33.0)),))
    assert chance_of_places(course, [replace_inputs(scene, inputs)], CONFIG) > 0.5
    unknown = replace_inputs(scene, replace(scene.inputs, position_m=None))
    assert chance_of_places(course, [unknown], CONFIG) == 1.0
