"""Friction that changes: what a switch keeps, what it changes, and what is refused."""

from dataclasses import replace

import numpy as np
import pytest

from odometry.errors import SimulationError
from odometry.simulation.contact.drive import simulate_contact
from odometry.simulation.contact.dynamics import MEMORY, ContactDynamics
from odometry.simulation.contact.friction import Coulomb, Shear
from odometry.simulation.contact.slope import Plane
from odometry.simulation.contact.traction import Traction, switched

LAW = Shear.for_modulus(0.006, 0.6)


@pytest.fixture
def turn():
    """4 s that speed up into a left turn."""
    return np.minimum(np.arange(201) / 50, 1.0)[:, None] * [0.3, 0.8]


def even(value, law=LAW, name="even", from_s=0.0, **more):
    return Traction(name, from_s, np.full((2, 3), value), law, **more)


def same(first, second):
    np.testing.assert_array_equal(first.poses_world, second.poses_world)
    np.testing.assert_array_equal(first.twists_body, second.twists_body)
    np.testing.assert_array_equal(first.accelerations_m_s2, second.accelerations_m_s2)


@pytest.mark.parametrize("kind", ["coulomb", "shear"])
def test_traction_like_the_vehicle_and_switches_to_the_same_change_no_bit(make_vehicle, turn, kind):
    vehicle = make_vehicle(kind)
    plain = simulate_contact(vehicle, turn, 0.02, ground=Plane(0.1, 0.5))
    pieces = [even(0.6, vehicle.law, name, at) for name, at in (("a", 0.0), ("b", 1.0), ("c", 2.5))]
    pieced = simulate_contact(vehicle, turn, 0.02, ground=Plane(0.1, 0.5), traction=pieces)
    same(plain, pieced)
    assert plain.terrains == ()
    assert pieced.terrains == ("a",) * 50 + ("b",) * 75 + ("c",) * 76


def test_until_a_switch_the_drive_is_the_old_one_and_then_another(make_vehicle, turn):
    vehicle = make_vehicle("shear")
    old = simulate_contact(vehicle, turn, 0.02)
    new = simulate_contact(
        vehicle, turn, 0.02, traction=[even(0.6), even(0.2, from_s=2.0, lateral_share=0.5)]
    )
    np.testing.assert_array_equal(new.twists_body[:101], old.twists_body[:101])
    assert np.abs(new.twists_body[102:] - old.twists_body[102:]).max(axis=1).min() > 1e-4


def test_after_a_switch_the_drive_settles_as_if_it_had_always_been_there(make_vehicle):
    held = np.tile([0.3, 0.8], (400, 1))
    vehicle = make_vehicle("shear")
    for law in (Coulomb(), Shear.for_modulus(0.002, 0.3)):
        after = even(0.3, law, from_s=2.0, lateral_share=0.8)
        changed = simulate_contact(vehicle, held, 0.02, traction=[even(0.6), after])
        always = simulate_contact(vehicle, held, 0.02, traction=[replace(after, from_s=0.0)])
        np.testing.assert_allclose(changed.twists_body[-1], always.twists_body[-1], atol=1e-5)


def test_shear_displacement_is_kept_and_begins_at_nothing_without_a_memory(make_vehicle):
    dynamics = ContactDynamics(make_vehicle("shear"), Plane())
    state = dynamics.start(np.zeros(2, complex), np.zeros(2))
    state += np.arange(1, state.shape[1] + 1) * (0.003 + 0.001j)
    friction = np.full((2, 2, 3), 0.4)
    other, kept = switched(dynamics, state, Traction("b", 0.0, friction, LAW))
    np.testing.assert_array_equal(kept, state)
    other, bare = switched(other, kept, Traction("c", 0.0, friction, Coulomb()))
    np.testing.assert_array_equal(bare, state[:, :MEMORY])
    _, fresh = switched(other, bare, Traction("d", 0.0, friction, LAW))
    np.testing.assert_array_equal(fresh[:, :MEMORY], bare)
    assert fresh.shape == state.shape
    assert not fresh[:, MEMORY:].any()


def test_a_stack_with_a_friction_each_gives_what_its_drives_give_alone(make_vehicle, turn, rng):
    vehicle = make_vehicle("shear")
    friction = rng.uniform(0.2, 0.8, (2, 2, 2, 3))
    pieces = [Traction("a", 0.0, friction[0], LAW), Traction("b", 1.5, friction[1], LAW)]
    stack = simulate_contact(vehicle, np.stack([turn, turn[:, ::-1]]), 0.02, traction=pieces)
    for row, speeds in enumerate((turn, turn[:, ::-1])):
        alone = simulate_contact(vehicle, speeds, 0.02, traction=[p[row] for p in pieces])
        np.testing.assert_allclose(stack[row].twists_body, alone.twists_body, atol=1e-9)
        np.testing.assert_array_equal(stack[row].traction[1].friction, friction[1, row])


def test_right_wheels_that_slip_in_a_left_turn_mirror_left_ones_in_a_right_turn(make_vehicle, turn):
    vehicle = make_vehicle("shear", x_cm=0.05, y_cm=0.0)
    slippery = np.array([[0.6, 0.6, 0.6], [0.3, 0.2, 0.6]])
    left, right = (
        simulate_contact(
            vehicle, speeds, 0.02, traction=[even(0.6), Traction("slip", 1.0, friction, LAW)]
        )
        for speeds, friction in ((turn, slippery), (turn[:, ::-1], slippery[::-1]))
    )
    np.testing.assert_allclose(left.twists_body, right.twists_body * [1, -1, -1], atol=1e-9)
    assert np.abs(left.twists_body[-1, 2]) > 0.1


@pytest.mark.parametrize("share", [0.6, 1.0, 1.4])
@pytest.mark.parametrize("law", [Coulomb(), Shear.for_modulus(0.01, 0.5)])
def test_the_share_sideways_sets_the_width_of_wide_turns(make_vehicle, share, law):
    """Slips are small against the speed: B (1 + share (L / B)^2), whatever friction and law."""
    vehicle = make_vehicle(x_cm=0.0, y_cm=0.0, places=[-0.3, 0.3])
    speeds = np.tile([0.298, 0.302], (400, 1))
    traction = [Traction("a", 0.0, np.full((2, 2), 0.5), law, share)]
    omega = simulate_contact(vehicle, speeds, 0.02, traction=traction).twists_body[-1, 2]
    assert 0.004 / omega == pytest.approx(0.8 * (1 + share * (0.6 / 0.8) ** 2), rel=2e-3)


@pytest.mark.parametrize(
    ("pieces", "message"),
    [
        ([even(0.6, from_s=1.0)], "begin at 0"),
        ([even(0.6), even(0.5)], "increase"),
        ([even(0.6), even(0.5, from_s=9.0)], "up to 4 s"),
        ([Traction("bad", 0.0, np.full((2, 2), 0.5), LAW)], r"'bad'.*\(2, 2\), expected \(2, 3\)"),
        ([Traction("bad", 0.0, np.full((5, 2, 3), 0.5), LAW)], "leading axes"),
        ([even(0.0)], "more than 0"),
        ([even(0.5, lateral_share=0.0)], "lateral_share 0"),
    ],
)
def test_traction_that_cannot_be_is_named(make_vehicle, turn, pieces, message):
    with pytest.raises(SimulationError, match=message):
        simulate_contact(make_vehicle(), turn, 0.02, traction=pieces)
