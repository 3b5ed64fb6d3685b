"""One vehicle in plain numbers where these end; `test_drive.py` compares it with a stack."""

import numpy as np

from odometry.simulation.contact.dynamics import YAW, ContactDynamics
from odometry.simulation.contact.one_vehicle import one_vehicle
from odometry.simulation.contact.slope import Plane


class OtherLaw:
    """A law of friction that plain numbers do not know."""


def test_a_heading_that_overflows_is_not_a_number_and_no_error(make_vehicle):
    dynamics = ContactDynamics(make_vehicle(), Plane())
    state = dynamics.start(np.zeros(1, complex), np.zeros(1))
    state[0, YAW] = np.inf
    after = one_vehicle(dynamics).advanced(state, np.zeros((1, 2)), 0.005, 4)
    assert after.shape == state.shape
    assert not np.isfinite(after).any()


def test_a_law_of_somebody_else_is_left_to_arrays(make_vehicle):
    dynamics = ContactDynamics(make_vehicle(), Plane())
    assert one_vehicle(dynamics) is not None
    assert one_vehicle(dynamics.on(dynamics.friction, OtherLaw(), 1.0)) is None
