"""Smooth functions that compete beside the catalogue: of angles, and of what varies."""

from dataclasses import replace

import numpy as np
import pytest

from odometry.effects.residual import ANGLES, COMPONENTS, HARMONICS, variables_of
from odometry.gap.candidates import (
    KNOTS,
    contact_effects,
    of_angles,
    of_variables,
    quick_effects,
)

LOSS = ("traction_loss", "k_m", "from_a_moment")


@pytest.fixture(scope="module")
def scenes(make_scene):
    """Over hills."""

    def same(_, twist):
        return twist

    return [make_scene(70, same), make_scene(71, same, duration_s=60.0)]


def test_of_every_angle_of_all_runs_with_and_without_the_speed(scenes):
    found = of_angles(scenes)
    both = {name for name in ANGLES if all(name in variables_of(s.inputs) for s in scenes)}
    assert both
    assert {(one.variable, one.by_speed) for one in found} == {
        (name, by_speed) for name in both for by_speed in (False, True)
    }
    for one in found:
        assert len(set(one.terms)) == len(one.terms) == len(COMPONENTS) * 2 * HARMONICS


def test_of_every_other_variable_at_knots_within_its_values(scenes):
    found = {one.variable: one for one in of_variables(scenes)}
    variables = variables_of(scenes[0].inputs)
    assert set(found) <= set(variables) - set(ANGLES)
    assert {"roll", "pitch"} <= set(found)
    for name, one in found.items():
        assert len(one.knots) == KNOTS
        assert (np.diff(one.knots) > 0).all()
        beyond = np.mean(variables[name][:, None] > np.array(one.knots), axis=0)
        np.testing.assert_allclose(beyond, np.linspace(0.98, 0.02, KNOTS), atol=0.05)


@pytest.mark.parametrize("share", [0.0, 1e-3], ids=["nothing", "next to nothing"])
def test_what_does_not_vary_is_left_out(scenes, share):
    """On ground that is all but level neither roll nor pitch says anything."""
    inputs = scenes[0].inputs
    level = replace(inputs, roll_rad=share * inputs.roll_rad, pitch_rad=share * inputs.pitch_rad)
    names = {one.variable for one in of_variables([replace(scenes[0], inputs=level)])}
    assert names
    assert not names & {"roll", "pitch"}


def test_a_moment_lies_after_one_window_and_before_another(scenes, known):
    """Of each run."""
    courses = [e for e in quick_effects(scenes, known) if e.key == LOSS]
    spans_s = [scene.pose_s[scene.windows[:, [0, -1]]] for scene in scenes]
    expected = tuple((float(of[:, 1].min()), float(of[:, 0].max())) for of in spans_s)
    assert [loss.in_time.observed_s for loss in courses] == [expected]


def test_forms_of_contact_forces_are_apart(scenes, known):
    quick, slow = quick_effects(scenes, known), contact_effects(scenes, known)
    assert {e.form for e in slow} == {"contact"}
    assert "contact" not in {e.form for e in quick}
    assert [e.key for e in slow if e.name == "slope_sliding"]
