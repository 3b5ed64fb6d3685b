"""The integrator: its order, its default step, and its closed-form solver."""

import numpy as np
import pytest

from odometry.simulation.contact.drive import simulate_contact
from odometry.simulation.contact.dynamics import VELOCITY, YAW_RATE, ContactDynamics
from odometry.simulation.contact.integrate import GAMMA, LONGEST_STEP_S, Damping
from odometry.simulation.contact.slope import Plane, Zones

LAWS = ("coulomb", "shear")
GROUND = Zones((0.02, 0.15), (0.6,), uphill_rad=0.8)


def weaving(duration_s, step_s):
    t = np.arange(round(duration_s / step_s) + 1) * step_s
    start = np.minimum(t / 1.0, 1.0)
    return start[:, None] * np.stack([0.4 + 0.4 * np.sin(0.9 * t), 0.4 - 0.3 * np.sin(0.7 * t)], -1)


@pytest.mark.parametrize("law", LAWS)
def test_the_error_falls_with_the_square_of_the_step(make_vehicle, law):
    """Through slips and sticks; the speeds are held, so their stamps do not change."""
    vehicle = make_vehicle(law, **({"rounding": 0.05} if law == "coulomb" else {}))
    ends = {}
    for steps in (8, 16, 32, 128):
        drive = simulate_contact(
            vehicle, weaving(2.0, 0.08), 0.08, ground=GROUND, longest_step_s=0.08 / steps
        )
        ends[steps] = drive.poses_world[-1, [0, 1, 5]]
    errors = [np.abs(ends[steps] - ends[128]).max() for steps in (8, 16, 32)]
    orders = -np.diff(np.log2(errors))
    assert (orders > 1.7).all(), orders
    assert (orders < 2.6).all(), orders


@pytest.mark.parametrize("law", LAWS)
def test_the_default_step_is_converged(make_vehicle, law):
    """5 s and some 2 m: a twentieth of the noise of a measured pose against a fifth of the step."""
    vehicle, speeds = make_vehicle(law), weaving(5.0, 0.02)
    drive, fine = (
        simulate_contact(vehicle, speeds, 0.02, ground=GROUND, longest_step_s=LONGEST_STEP_S / n)
        for n in (1, 5)
    )
    error = np.abs(drive.poses_world - fine.poses_world).max(axis=0)
    assert (error[:3] < 5e-4).all(), error
    assert (error[3:] < 2.5e-4).all(), error


def test_stages_solve_the_linear_system(make_vehicle, rng):
    """(1 - h gamma A) k = b with A assembled contact by contact."""
    vehicle, step = make_vehicle("shear"), 0.004
    dynamics = ContactDynamics(vehicle, Plane())
    state = dynamics.start(np.zeros(1, complex), np.zeros(1))
    state[:, VELOCITY], state[:, YAW_RATE] = 0.2 - 0.1j, 0.4
    rate, contacts = dynamics.rate(state, np.array([[0.1, 0.5]]))
    right = rng.normal(size=rate.shape) + 1j * rng.normal(size=rate.shape)
    right[:, YAW_RATE] = right[:, YAW_RATE].real
    found = Damping(dynamics, contacts, step).solve(right.copy())[0]
    matrix = np.zeros((3, 3))
    for damping, place in zip(contacts.damping_kg_s[0], vehicle.places_m, strict=True):
        arm = place - (0.05 - 0.03j)
        reach = np.array([[1.0, 0.0, -arm.imag], [0.0, 1.0, arm.real]])
        matrix -= damping * np.diag([1 / 120, 1 / 120, 1 / 15]) @ reach.T @ reach
    vector = [right[0, VELOCITY].real, right[0, VELOCITY].imag, right[0, YAW_RATE].real]
    expected = np.linalg.solve(np.eye(3) - step * GAMMA * matrix, vector)
    velocity, turn = found[VELOCITY], found[YAW_RATE].real
    np.testing.assert_allclose([velocity.real, velocity.imag, turn], expected, rtol=1e-12)
