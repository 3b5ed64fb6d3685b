"""Normal loads against the balance of moments in space and against least spring energy."""

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from scipy.optimize import minimize

from odometry.errors import SimulationError
from odometry.simulation.contact.dynamics import NormalLoads

PLACES = np.array([-0.5 + 0.4j, 0.1 + 0.4j, 0.6 + 0.4j, -0.5 - 0.4j, 0.1 - 0.4j, 0.6 - 0.4j])
WEIGHT_N, HEIGHT_M = 1000.0, 0.5
CENTRE = np.array([0.05, -0.03, HEIGHT_M])


def loads_under(force_x, force_y):
    """Loads while the ground pushes with a force in its plane."""
    moment = WEIGHT_N * complex(*CENTRE[:2]) - HEIGHT_M * complex(force_x, force_y)
    return NormalLoads(PLACES)(np.array([WEIGHT_N]), np.array([moment]))[0]


@given(st.floats(-500, 500), st.floats(-500, 500))
def test_forces_and_moments_balance_in_space(force_x, force_y):
    """About the centre of mass, by cross products; the in-plane force acts at the ground."""
    loads = loads_under(force_x, force_y)
    assert (loads >= 0).all()
    assert loads.sum() == pytest.approx(WEIGHT_N)
    arms = np.column_stack([PLACES.real, PLACES.imag, np.zeros(6)]) - CENTRE
    pushes = np.column_stack([np.full(6, force_x / 6), np.full(6, force_y / 6), loads])
    moment = np.cross(arms, pushes).sum(axis=0)
    np.testing.assert_allclose(moment[:2], 0.0, atol=1e-8)


@pytest.mark.parametrize("force", [(0.0, 0.0), (300.0, -100.0), (-500.0, 450.0), (200.0, 550.0)])
def test_loads_have_the_least_energy_of_equal_springs(force):
    """Of all non-negative loads that balance, springs take those of least sum of squares."""
    arms = np.stack([np.ones(6), PLACES.real, PLACES.imag])
    right = [WEIGHT_N, *(WEIGHT_N * CENTRE[:2] - HEIGHT_M * np.array(force))]
    found = minimize(
        lambda loads: (loads @ loads) / 1e5,
        np.full(6, WEIGHT_N / 6),
        jac=lambda loads: 2 * loads / 1e5,
        bounds=[(0, None)] * 6,
        constraints={"type": "eq", "fun": lambda loads: (arms @ loads - right) / 100},
        method="SLSQP",
        options={"ftol": 1e-14, "maxiter": 500},
    )
    np.testing.assert_allclose(loads_under(*force), found.x, atol=0.01)


def test_braking_loads_the_front_and_lifts_the_rear():
    loads = loads_under(-800.0, 0.0)
    assert loads[2] > loads[1] > loads[0] == 0.0


def test_rows_do_not_depend_on_each_other():
    rng = np.random.default_rng(1)
    moments = WEIGHT_N * (rng.uniform(-0.45, 0.55, 40) + 1j * rng.uniform(-0.38, 0.38, 40))
    together = NormalLoads(PLACES)(np.full(40, WEIGHT_N), moments)
    alone = [NormalLoads(PLACES)(np.array([WEIGHT_N]), moments[[i]])[0] for i in range(40)]
    np.testing.assert_allclose(together, alone, atol=1e-9)
    assert (together.min(axis=1) == 0).sum() > 5


@pytest.mark.parametrize("force", [(0.0, 1000.0), (-1200.0, 0.0), (900.0, 800.0)])
def test_a_vehicle_that_tips_over_is_named(force):
    with pytest.raises(SimulationError, match="tips over"):
        loads_under(*force)
