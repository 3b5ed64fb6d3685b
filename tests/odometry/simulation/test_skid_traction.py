"""Grounds and slipping wheels: which wheel is which, names, and what is refused."""

from pathlib import Path

import numpy as np
import pytest

from odometry.errors import SimulationError
from odometry.simulation.contact.drive import simulate_contact
from odometry.simulation.contact.steady_state import steady_state
from odometry.simulation.contact.vehicle import read_contact_vehicle
from odometry.simulation.skid_experiments import (
    GROUNDS,
    WHEEL_MODES,
    ground_traction,
    wheel_mode_name,
    wheel_traction,
)

VEHICLES = Path(__file__).parents[3] / "data" / "vehicles"


@pytest.fixture(scope="module")
def husky():
    return read_contact_vehicle(VEHICLES / "husky_like.toml")


def test_sixteen_combinations_have_sixteen_names_and_frictions(husky):
    names = [wheel_mode_name(mode) for mode in WHEEL_MODES]
    assert len(set(names)) == 16
    assert (names[0], names[-1]) == ("none", "all")
    frictions = [wheel_traction(husky, mode).friction for mode in WHEEL_MODES]
    assert len({friction.tobytes() for friction in frictions}) == 16
    for mode, friction in zip(WHEEL_MODES, frictions, strict=True):
        assert (friction == 0.3).sum() == len(mode)
        assert set(friction.ravel()) <= {0.3, 0.6}


def test_wheels_are_where_their_names_say(husky):
    places = husky.places_m.reshape(2, 2)
    for name, forward, left in (("front_left", 1, 1), ("rear_right", -1, -1)):
        slips = wheel_traction(husky, [name]).friction == 0.3
        assert np.sign(places[slips].real).tolist() == [forward]
        assert np.sign(places[slips].imag).tolist() == [left]
    j8 = read_contact_vehicle(VEHICLES / "j8.toml")
    four_a_side = wheel_traction(j8, ["front_right", "rear_right"]).friction
    np.testing.assert_array_equal(four_a_side, [[0.6] * 4, [0.3] * 4])


def test_no_wheel_slipping_is_the_vehicle_at_its_own_friction(husky):
    speeds = np.minimum(np.arange(101) / 50, 1.0)[:, None] * [0.3, 0.8]
    own = simulate_contact(husky.with_friction(0.6), speeds, 0.02)
    none = simulate_contact(husky, speeds, 0.02, traction=[wheel_traction(husky, [])])
    np.testing.assert_array_equal(own.poses_world, none.poses_world)


def test_terrains_have_the_friction_requested_and_each_its_own_width(husky):
    assert [ground.friction for ground in GROUNDS.values()] == [0.8, 0.55, 0.35]
    speeds = np.minimum(np.arange(301) / 50, 1.0)[:, None] * [0.45, 0.55]
    widths = [
        0.1 / simulate_contact(husky, speeds, 0.02, traction=[piece]).twists_body[-1, 2]
        for piece in (ground_traction(husky, name) for name in GROUNDS)
    ]
    expected = [
        0.55 * (1 + ground.lateral_share * (0.512 / 0.55) ** 2) for ground in GROUNDS.values()
    ]
    np.testing.assert_allclose(widths, expected, rtol=0.01)


def test_at_low_speed_all_wheels_slipping_turn_as_none(husky):
    """Friction drops out of the balance where nothing accelerates much (lateral, 0.02 m/s2)."""
    pair = np.array([[0.08, 0.14]])
    twists = [steady_state(husky.with_friction(friction), pair)[0] for friction in (0.6, 0.3)]
    np.testing.assert_allclose(twists[0], twists[1], rtol=2e-3, atol=1e-4)


@pytest.mark.parametrize("wheels", [["middle_left"], ["front_left", "front"]])
def test_an_unknown_wheel_is_named(husky, wheels):
    with pytest.raises(SimulationError, match=f"no wheel '{wheels[-1]}'; there are front_left"):
        wheel_traction(husky, wheels)


def test_an_unknown_terrain_is_named(husky):
    with pytest.raises(SimulationError, match="no terrain 'ice'; there are asphalt"):
        ground_traction(husky, "ice")
