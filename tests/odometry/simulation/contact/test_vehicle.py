"""Vehicles from tables and files; wrong ones are named."""

from pathlib import Path

import numpy as np
import pytest

from odometry.errors import SimulationError
from odometry.simulation.contact.friction import Coulomb, Shear
from odometry.simulation.contact.vehicle import read_contact_vehicle

VEHICLES = Path(__file__).parents[4] / "data" / "vehicles"
NAMES = ("auriga_alpha", "lazaro", "j8", "warthog_like", "husky_like")


@pytest.mark.parametrize("name", NAMES)
def test_shipped_vehicles_stand_on_their_contacts(name):
    vehicle = read_contact_vehicle(VEHICLES / f"{name}.toml")
    assert vehicle.robot["name"] == name
    assert isinstance(vehicle.law, Shear)
    coulomb = read_contact_vehicle(VEHICLES / f"{name}.toml", {"law": "coulomb"})
    assert coulomb.law == Coulomb()


def test_places_are_those_of_the_left_side_then_the_right(make_vehicle):
    places = make_vehicle().places_m
    np.testing.assert_allclose(places.real, [-0.45, 0.1, 0.4] * 2)
    np.testing.assert_allclose(places.imag, [0.4] * 3 + [-0.4] * 3)


def test_a_tracks_tread_comes_in_at_the_leading_edge(make_vehicle):
    vehicle = make_vehicle(patch_length=None, track_length=1.2)
    np.testing.assert_allclose(vehicle.entry_m, [[1.05, 0.5, 0.2], [0.15, 0.7, 1.0]])
    np.testing.assert_allclose(make_vehicle().entry_m, 0.05)


def test_friction_of_each_contact_and_another_mean(make_vehicle):
    vehicle = make_vehicle(
        friction=None, friction_left=[0.2, 0.4, 0.6], friction_right=[0.3, 0.5, 0.4]
    )
    assert vehicle.friction[1, 0] == 0.3
    other = vehicle.with_friction(0.8)
    np.testing.assert_allclose(other.friction, 2 * vehicle.friction)


@pytest.mark.parametrize(
    ("changes", "message"),
    [
        ({"law": "viscous"}, "law = 'viscous', expected one of coulomb, shear"),
        ({"yaw_inertia": 0.0}, "yaw_inertia = 0.0, expected more than 0"),
        ({"friction": -0.1}, "friction = -0.1"),
        ({"height": -0.1}, "height = -0.1"),
        ({"modulus": 0.0}, "modulus = 0.0"),
        ({"places": []}, "expected 2 or more different places"),
        ({"places": [0.1]}, "expected 2 or more different places"),
        ({"places": [0.1, 0.1, 0.2]}, "expected 2 or more different places"),
        ({"patch_length": None, "track_length": 0.5}, "distance from entry"),
        ({"friction": 1e-300}, "friction = 1e-300"),
        ({"friction": 1e300}, "friction = 1e"),
        ({"modulus": float("nan")}, "modulus = nan"),
        ({"yaw_inertia": 1e300}, "yaw_inertia = 1e"),
        ({"height": float("inf")}, "height = inf"),
        ({"slip": 1.0}, "unknown key 'slip'"),
        ({"friction": None, "friction_left": [0.1], "friction_right": [0.2]}, r"shape \(2, 3\)"),
    ],
)
def test_impossible_vehicles_are_named(make_vehicle, changes, message):
    with pytest.raises(SimulationError, match=message):
        make_vehicle(**changes)


@pytest.mark.parametrize(
    ("text", "message"),
    [
        ("[robot]\ntrack_width = 1.0\n", r"table \[contact\] is missing"),
        ("[robot]\ntrack_width = 1.0\n[contact]\nplaces = [0, 1]\n", "missing in"),
        ("[robot]\n[contact]\nplaces = 'x'\n", r"v\.toml"),
    ],
)
def test_wrong_files_are_named(tmp_path, text, message):
    (tmp_path / "v.toml").write_text(text)
    with pytest.raises(SimulationError, match=message):
        read_contact_vehicle(tmp_path / "v.toml")
