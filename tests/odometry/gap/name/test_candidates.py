"""Effects of the catalogue that are offered, by what was recorded."""

from types import SimpleNamespace

import numpy as np
import pytest

from odometry.effects.commands.wheel_scale import WheelScale
from odometry.effects.motion.contact_effects import InertiaByContact
from odometry.gap.name.candidates import contact_effects, of_the_same_robot, quick_effects

LOSS = ("traction_loss", "k_m", "from_a_moment")


@pytest.fixture(scope="module")
def scenes(make_scene):
    """Over hills."""

    def same(_, twist):
        return twist

    return [make_scene(70, same), make_scene(71, same, duration_s=60.0)]


def test_a_moment_lies_after_some_way_and_before_a_window(scenes, known):
    """Of each run: a twentieth of the way, and a whole window."""
    (loss,) = (e for e in quick_effects(scenes, known) if e.key == LOSS)
    for scene, (first_s, last_s) in zip(scenes, loss.in_time.observed_s, strict=True):
        way_m = np.interp(
            [scene.time_s[0], first_s, scene.time_s[-1]], scene.time_s, scene.travel_m
        )
        assert (way_m[1] - way_m[0]) / (way_m[2] - way_m[0]) == pytest.approx(0.05)
        assert first_s > scene.pose_s[scene.windows[:, -1]].min()
        assert last_s == scene.start_s.max()


def test_forms_of_contact_forces_are_apart(scenes, known):
    quick, slow = quick_effects(scenes, known), contact_effects(scenes, known)
    assert {e.form for e in slow} == {"contact"}
    assert "contact" not in {e.form for e in quick}
    assert [e.key for e in slow if e.name == "slope_sliding"]


@pytest.mark.parametrize(("lateral_m_s2", "count"), [(0.05, 0), (0.13, 3)])
def test_inertia_by_contacts_needs_no_fast_turn(known, lateral_m_s2, count):
    """Mass follows late in slow turns, too; of a drive that hardly turns nothing is known."""
    recorded = SimpleNamespace(base=known.base, lateral_m_s2=lateral_m_s2)
    assert len(InertiaByContact.offered(recorded)) == count


def test_a_robot_has_one_number_of_contacts():
    """Of a physics that was named; what has no physics of its own is free."""
    few, many = InertiaByContact(contacts=2.0), InertiaByContact(contacts=4.0)
    scale = WheelScale()
    candidates = (few, many, scale)
    assert of_the_same_robot(candidates, [few, scale]) == (few, scale)
    assert of_the_same_robot(candidates, []) == candidates
