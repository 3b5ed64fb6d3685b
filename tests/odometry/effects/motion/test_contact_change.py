"""What gravity along a slope, and centrifugal force, change of a force balance."""

from types import SimpleNamespace

import numpy as np
import pytest

from odometry.effects.interface.corrected import Added, corrected_twist
from odometry.effects.motion.contact_effects import InertiaByContact, SlopeByContact
from odometry.models.catalogue import MODELS
from odometry.models.inputs import Inputs
from odometry.simulation.contact.steady_state import steady_state
from odometry.simulation.contact.vehicle import contact_vehicle

VALUES = np.array([0.5, 0.2, 0.3, 0.02, 0.01])  # mu, height, half_length, x_cm, slip_scale
BALANCE = np.array([0.5, 1.0, 0.02, 0.0, 0.2, 0.3, 0.3, 2.0, 0.01])

MU, HEIGHT, HALF_LENGTH, HALF_WIDTH, ROUNDING = 0.67, 0.16, 0.17, 0.2, 0.02
SLOWER = 0.2  # centrifugal force is 0.04 of its own


def settled(speeds, times):
    """Twists of a robot on three axles at so many times the speeds, slip as much smaller."""
    body = {
        "name": "six wheels",
        "track_width": 2 * HALF_WIDTH,
        "length": 0.5,
        "width": 0.5,
        "wheel_radius": 0.1,
        "mass": 20.0,
    }
    contact = {
        "x_cm": 0.0,
        "y_cm": 0.0,
        "height": HEIGHT,
        "yaw_inertia": 1.0,
        "settling": 0.1,
        "patch_length": 0.05,
        "friction": MU,
        "places": [-HALF_LENGTH, 0.0, HALF_LENGTH],
        "law": "coulomb",
        "rounding": times * ROUNDING,
    }
    twists, still = steady_state(contact_vehicle(body, contact), times * speeds)
    assert still.all()
    return twists


def change(bench, effect, inputs):
    found = corrected_twist(bench.base, [Added(effect, VALUES)], inputs)
    return found - bench.base.model.twist(bench.values, inputs)


def constant(speeds, roll=0.0, pitch=0.0, count=30):
    tilt = np.full((2, count), [[roll], [pitch]])
    return Inputs(np.tile(speeds, (count, 1)), *tilt, time_s=0.02 * np.arange(count))


def test_slope_changes_nothing_on_level_ground(bench, rng):
    level = bench.drive(rng, 60, tilt_rad=0.0)
    np.testing.assert_allclose(change(bench, SlopeByContact(), level), 0, atol=1e-9)
    assert "not level" in SlopeByContact().lacks(level, bench.base)


def test_a_turn_on_a_slope_slides_downhill(bench):
    """Right side down: to the right; nose down: forward. Turning on the spot."""
    on_the_spot = [-0.4, 0.4]
    to_the_right = change(bench, SlopeByContact(), constant(on_the_spot, roll=0.15))
    assert (to_the_right[:, 1] < -0.01).all()
    forward = change(bench, SlopeByContact(), constant(on_the_spot, pitch=0.15))
    assert (forward[:, 0] > 0.01).all()


def test_slope_is_the_balance_on_the_slope_less_that_on_the_level(bench):
    inputs = constant([0.1, 0.6], roll=0.1, pitch=-0.08)
    on_slope = MODELS["contact"].twist(BALANCE, inputs)
    level = MODELS["contact"].twist(BALANCE, Inputs(inputs.tread_speeds_m_s))
    found = change(bench, SlopeByContact(), inputs)
    np.testing.assert_allclose(found, on_slope - level, atol=1e-9)


def test_inertia_changes_nothing_while_slow_and_straight(bench):
    """A hundredth of the speed has a ten-thousandth of the force; straight ahead has none."""
    fast = np.abs(change(bench, InertiaByContact(), constant([0.6, 1.8]))).max()
    slow = np.abs(change(bench, InertiaByContact(), constant([0.006, 0.018]))).max()
    straight = np.abs(change(bench, InertiaByContact(), constant([1.5, 1.5]))).max()
    assert fast > 0.01
    assert slow < 1e-4 * fast
    assert straight < 1e-9


def test_viscous_contacts_stay_what_they_are_while_slow(bench):
    """Slip scales with the speeds, so that slowness alone changes nothing."""
    base, inputs = bench.base, constant([0.006, 0.018])
    values = np.array([0.5, 0.2, 0.3, 0.1, 0.01])
    found = corrected_twist(base, [Added(InertiaByContact(), values)], inputs)
    change = found - base.model.twist(bench.values, inputs)
    np.testing.assert_allclose(change, 0, atol=1e-6)


def test_inertia_does_not_see_the_slope(bench):
    level = change(bench, InertiaByContact(), constant([0.6, 1.8]))
    tilted = change(bench, InertiaByContact(), constant([0.6, 1.8], roll=0.1, pitch=0.1))
    np.testing.assert_array_equal(level, tilted)


@pytest.mark.parametrize("effect", [SlopeByContact, InertiaByContact])
def test_other_values_before_do_not_change_the_answer(bench, effect, monkeypatch):
    """A balance that is searched from that of other values is the same; few are remembered."""
    monkeypatch.setattr("odometry.effects.interface.remembered.MOST", 2)
    used = effect()
    for factor in (1.0, 1.3, 0.8, 1.0):
        for speeds in ([0.4, 1.2], [0.2, 1.4], [0.1, 0.3]):
            inputs, values = constant(speeds, 0.1), VALUES * factor
            before, fresh = (
                corrected_twist(bench.base, [Added(of, values)], inputs) for of in (used, effect())
            )
            np.testing.assert_allclose(before, fresh, atol=1e-12)


@pytest.mark.parametrize("effect", [SlopeByContact, InertiaByContact])
def test_what_it_remembers_is_what_it_computes(bench, effect):
    """One instance, asked in turn of other inputs and values, answers as new ones do."""
    used = effect()
    for _ in range(2):
        for speeds, roll in (([0.4, 1.2], 0.1), ([0.4, 1.2], 0.05), ([0.2, 1.4], 0.1)):
            inputs = constant(speeds, roll)
            np.testing.assert_allclose(
                change(bench, used, inputs), change(bench, effect(), inputs), atol=1e-12
            )


@pytest.mark.parametrize(
    ("place", "value", "meant"),
    [(0, 2.0, False), (0, 0.1, False), (1, 0.0, True), (2, 2.0, False), (3, -0.3, False)],
)
def test_values_at_an_end_of_the_search_are_no_robot(place, value, meant):
    """But a mass at the height of the terrain, and contacts without slip scale, are near some."""
    assert SlopeByContact().is_meant(VALUES)
    changed = np.where(np.arange(5) == place, value, VALUES)
    assert SlopeByContact().is_meant(changed) == meant
    assert SlopeByContact().is_meant(np.array([0.5, 0.2, 0.3, 0.02, 1e-3]))


def test_contacts_all_along_the_treads_resist_a_turn_less_than_those_at_the_ends(bench):
    """Cornering, as many as four a side let a robot out of its turn by another angle than two."""
    fast = constant([0.6, 1.8])
    ends, many = (change(bench, InertiaByContact(0.3, count), fast) for count in (2.0, 4.0))
    np.testing.assert_array_equal(ends, change(bench, InertiaByContact(0.3), fast))
    assert np.abs(many - ends).max() > 0.01
    assert InertiaByContact(0.3, 4.0).constants() == {"half_width": 0.3, "contacts": 4.0}


def test_three_axles_turn_otherwise_when_fast_than_two_or_treads():
    """Beside the transient simulator, settled: a robot of six wheels, fast and a fifth as fast."""
    speeds = np.array([[0.9, 1.5], [0.4, 1.2]])
    of_motion = [settled(speeds, 1.0), settled(speeds, SLOWER) / SLOWER]
    truth = of_motion[0] - of_motion[1]
    robot = SimpleNamespace(track_width=2 * HALF_WIDTH)
    recorded = SimpleNamespace(base=SimpleNamespace(robot=robot), lateral_m_s2=1.0)
    values = np.array([MU, HEIGHT, HALF_LENGTH, 0.0, ROUNDING])
    inputs = Inputs(speeds)
    base = SimpleNamespace(robot=robot)
    off = {
        form.constants().get("contacts"): np.abs(form.change(values, inputs, base) - truth).max()
        for form in InertiaByContact.offered(recorded)
    }
    assert off.pop(3.0) < 0.1 * np.abs(truth).max()
    assert all(one > np.abs(truth).max() for one in off.values())
