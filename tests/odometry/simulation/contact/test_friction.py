"""Friction laws against closed forms and integration by another program."""

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from scipy.integrate import solve_ivp

from odometry.simulation.contact.friction import Coulomb, Shear

SHEAR = Shear.for_modulus(0.006, 0.5)
NONE = np.zeros(1, dtype=np.complex128)
slips = st.complex_numbers(max_magnitude=3.0, min_magnitude=1e-6)


def traction(law, slip, displacement, renewal):
    rate = law.displacement_rate(slip, displacement, renewal)
    opposed, factor = law.yielding(slip, displacement, rate)
    return -opposed * factor


def steady_displacement(slip, renewal):
    """Integrate dj/dt to its end with SciPy."""

    def rate(_, j):
        return SHEAR.displacement_rate(slip, j, renewal)

    return solve_ivp(rate, (0.0, 20.0), NONE, rtol=1e-8, atol=1e-12).y[:, -1]


@given(slips)
def test_coulomb_opposes_the_slip_with_all_its_friction(slip):
    force = traction(Coulomb(0.005), np.array([slip]), NONE[:0], np.ones(1))[0]
    assert abs(force) == pytest.approx(abs(slip) / np.hypot(abs(slip), 0.005))
    assert force / abs(force) == pytest.approx(-slip / abs(slip))


@given(slips, st.complex_numbers(max_magnitude=0.03), st.floats(0.0, 20.0))
def test_shear_is_bounded_by_its_friction(slip, displacement, renewal):
    force = traction(SHEAR, np.array([slip]), np.array([displacement]), np.array([renewal]))
    assert abs(force[0]) <= 1.0


def test_small_slip_gives_the_shear_of_wong_and_chiang():
    """j = slip x time in contact, traction 1 - exp(-j / K)."""
    slip, renewal = np.array([0.001 - 0.002j]), np.array([8.0])
    j = steady_displacement(slip, renewal)
    expected = slip / renewal
    np.testing.assert_allclose(j, expected, rtol=abs(expected[0]) / SHEAR.longest_m)
    force = traction(SHEAR, slip, j, renewal)
    size = abs(j) / SHEAR.modulus_m
    np.testing.assert_allclose(force, -(1 - np.exp(-size)) * slip / abs(slip), rtol=1e-6)


def test_a_locked_tread_slides_with_nearly_all_its_friction():
    slip = np.array([-0.3 + 0.4j])
    j = steady_displacement(slip, np.zeros(1))
    np.testing.assert_allclose(j, SHEAR.longest_m * slip / 0.5, rtol=1e-6)
    force = traction(SHEAR, slip, j, np.zeros(1))
    np.testing.assert_allclose(abs(force), 1 - np.exp(-5), rtol=1e-6)


def test_a_standing_block_swings_as_a_damped_spring():
    """Small swings of a block on the bristles: stiffness mu N / K, damping ratio 0.5."""
    law, limit = Shear.for_modulus(0.01, 0.5, damping_ratio=0.5), 0.5 * 9.80665
    times = np.linspace(0.0, 1.0, 51)

    def rate(_, state):
        memory, slip = np.array([state[0] + 0j]), np.array([state[1] + 0j])
        force = limit * traction(law, slip, memory, np.zeros(1)).real[0]
        return [law.displacement_rate(slip, memory, np.zeros(1)).real[0], force]

    swing = solve_ivp(rate, (0.0, 1.0), [0.0, 1e-5], t_eval=times, rtol=1e-10, atol=1e-14).y[1]
    frequency = np.sqrt(limit / 0.01)
    damped = frequency * np.sqrt(0.75)
    decay = np.exp(-0.5 * frequency * times)
    sine = 0.5 * frequency / damped * np.sin(damped * times)
    np.testing.assert_allclose(swing, 1e-5 * decay * (np.cos(damped * times) - sine), atol=1e-8)
