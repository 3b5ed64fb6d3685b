"""Smooth functions that compete with the catalogue: of all that was recorded and varies."""

from dataclasses import replace

import numpy as np
import pytest

from odometry.effects.unknown.history import HISTORY
from odometry.effects.unknown.residual import (
    ANGLES,
    COMPONENTS,
    HARMONICS,
    OF_TREADS,
    TREADS,
    VARIABLES,
    variables_of,
)
from odometry.effects.unknown.residual_of_place import PLACE
from odometry.effects.unknown.residual_variables import FURTHER, WHAT_WENT_BEFORE
from odometry.gap.config import GapConfig
from odometry.gap.name.general import general_candidates, shares_of_motion, single_candidates

CONFIG = GapConfig()


def with_stop(scene):
    """The same scene with a second of rest in the middle."""
    inputs = scene.inputs
    rests = np.abs(inputs.time_s - inputs.time_s[-1] / 2) < 0.5
    speeds = np.where(rests[:, None], 0.0, inputs.tread_speeds_m_s)
    return replace(scene, inputs=replace(inputs, tread_speeds_m_s=speeds))


@pytest.fixture(scope="module")
def scenes(make_scene):
    """Over hills, with a stop in each."""

    def same(_, twist):
        return twist

    return [with_stop(make_scene(70, same)), with_stop(make_scene(71, same, duration_s=60.0))]


@pytest.fixture(scope="module")
def found(scenes, known):
    return general_candidates(scenes, known.base, CONFIG)


def test_every_variable_is_tried(found):
    assert {one.variable for one in found} - {PLACE} == set(VARIABLES) - set(WHAT_WENT_BEFORE)


def test_of_every_angle_with_and_without_the_speed(found):
    for name in ANGLES:
        both = [one for one in found if one.variable == name]
        assert [one.by for one in both] == ["", "speed"]
        for one in both:
            assert len(set(one.terms)) == len(one.terms) == len(COMPONENTS) * (2 * HARMONICS + 1)


def test_of_every_other_variable_at_knots_within_its_values(found, scenes, known):
    twists = [known.base.model.twist(known.base.values, s.inputs) for s in scenes]
    of_scenes = [variables_of(s.inputs, t) for s, t in zip(scenes, twists, strict=True)]
    for one in found:
        if one.variable in (*ANGLES, *OF_TREADS, PLACE):
            continue
        values = np.concatenate([of[one.variable] for of in of_scenes])
        assert (np.diff(one.knots) > 0).all()
        beyond = np.mean(values[:, None] > np.array(one.knots), axis=0)
        np.testing.assert_allclose(beyond, np.linspace(0.98, 0.02, CONFIG.knots), atol=0.05)


def test_a_tread_follows_its_own_motion_on_both_sides_of_rest(found):
    for name in set(OF_TREADS) - {*WHAT_WENT_BEFORE, *FURTHER}:
        (one,) = [other for other in found if other.variable == name]
        assert {component for component, _ in one.terms} == set(TREADS)
        np.testing.assert_allclose(one.knots, -np.flip(one.knots))
        assert 0.0 in one.knots


def test_time_takes_shares_of_the_treads_or_adds_a_motion(found):
    shares, motion = sorted(
        (one for one in found if one.variable == "time"), key=lambda one: -len(one.by)
    )
    assert {component for component, _ in shares.terms} == set(TREADS)
    assert {component for component, _ in motion.terms} == set(COMPONENTS)


@pytest.mark.parametrize("share", [0.0, 1e-3], ids=["nothing", "next to nothing"])
def test_what_does_not_vary_is_left_out(scenes, known, share):
    """On terrain that is all but level neither roll nor pitch says anything."""
    inputs = scenes[0].inputs
    level = replace(inputs, roll_rad=share * inputs.roll_rad, pitch_rad=share * inputs.pitch_rad)
    scene = replace(scenes[0], inputs=level)
    names = {one.variable for one in general_candidates([scene], known.base, CONFIG)}
    assert names
    assert not names & {"roll", "pitch"}


def test_single_ones_add_to_one_component_or_tread(scenes, known):
    single = single_candidates(scenes, known.base, CONFIG)
    assert {one.variable for one in single} == {*VARIABLES, HISTORY}
    assert len({(one.key, getattr(one, "knots", ())) for one in single}) == len(single)
    for one in single:
        assert len({component for component, _ in one.terms}) == 1


def test_shares_of_the_whole_motion_have_knots_even_in_the_variable_as_well(scenes, known):
    for found in (
        shares_of_motion(scenes, known.base, CONFIG),
        single_candidates(scenes, known.base, CONFIG),
    ):
        evenly = [
            one
            for one in found
            if len(one.knots) == CONFIG.even_knots and np.ptp(np.diff(one.knots)) < 1e-9
        ]
        assert {(one.by, one.terms[0][0]) for one in evenly} == {("v_x", "v_x"), ("omega", "omega")}
        assert "speed" in {one.variable for one in evenly}
