"""Vehicles of the tests: asymmetric, so that a swapped side or sign shows."""

import pytest

from odometry.simulation.contact.vehicle import contact_vehicle

ROBOT = {"name": "test", "track_width": 0.8, "mass": 120.0}
CONTACT = {
    "yaw_inertia": 15.0,
    "x_cm": 0.05,
    "y_cm": -0.03,
    "height": 0.3,
    "places": [-0.45, 0.1, 0.4],
    "patch_length": 0.1,
    "friction": 0.6,
    "settling": 0.1,
}
LAWS = {
    "coulomb": {"law": "coulomb", "rounding": 0.005},
    "shear": {"law": "shear", "modulus": 0.006},
}


@pytest.fixture
def make_vehicle():
    """A vehicle with some keys of [contact] changed; a change to None takes the key away."""

    def make(kind="coulomb", /, **changes):
        contact = {**CONTACT, **LAWS[kind], **changes}
        return contact_vehicle(ROBOT, {k: v for k, v in contact.items() if v is not None})

    return make
