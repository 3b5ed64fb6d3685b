"""Loads of equal springs that cannot pull, against statics by hand and a quadratic programme."""

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from scipy.optimize import minimize

from odometry.models.contact_stance import even_layout, load_shares

inside = st.floats(-0.95, 0.95)
a_side = st.integers(2, 7)


def shares_of(contacts, centre):
    layout = even_layout(np.array([contacts], float))
    shares, slopes = load_shares(np.array(centre)[:, None], layout)
    return layout.places[..., 0], shares[:, 0], slopes[..., 0]


def test_contacts_are_evenly_spaced_on_both_sides():
    places, _, _ = shares_of(3, (0.0, 0.0))
    np.testing.assert_array_equal(places[1], [-1, 0, 1, -1, 0, 1])
    np.testing.assert_array_equal(places[2], [1, 1, 1, -1, -1, -1])


@pytest.mark.parametrize(
    ("centre", "rear_left", "front_left", "rear_right", "front_right"),
    [
        ((0.0, 0.0), 0.25, 0.25, 0.25, 0.25),
        ((0.5, 0.0), 0.125, 0.375, 0.125, 0.375),
        ((0.0, -0.5), 0.125, 0.125, 0.375, 0.375),
        ((0.5, 0.5), 0.25, 0.5, 0.0, 0.25),  # just before the rear right wheel lifts off
        ((0.6, 0.6), 0.2, 0.6, 0.0, 0.2),  # statics of the three that are left
        ((-0.6, -0.6), 0.2, 0.0, 0.6, 0.2),
    ],
)
def test_four_wheels_by_hand(centre, rear_left, front_left, rear_right, front_right):
    _, shares, _ = shares_of(2, centre)
    expected = [rear_left, front_left, rear_right, front_right]
    np.testing.assert_allclose(shares, expected, atol=1e-15)


@given(contacts=a_side, forward=inside, side=inside)
def test_loads_balance_and_lie_on_a_plane(contacts, forward, side):
    """Force and both moments; what bears lies on one plane, the rest below its zero."""
    places, shares, _ = shares_of(contacts, (forward, side))
    np.testing.assert_allclose(places @ shares, [1, forward, side], atol=1e-13)
    assert np.all(shares >= 0)
    bearing = shares > 0
    plane, *_ = np.linalg.lstsq(places[:, bearing].T, shares[bearing])
    np.testing.assert_allclose(places[:, bearing].T @ plane, shares[bearing], atol=1e-12)
    assert np.all(places[:, ~bearing].T @ plane < 1e-12)


@pytest.mark.parametrize("contacts", [2, 3, 5])
def test_the_springs_store_the_least_energy(contacts, rng):
    """Castigliano: among the loads that balance, those that minimise the sum of their squares."""
    for centre in rng.uniform(-0.9, 0.9, (6, 2)):
        places, shares, _ = shares_of(contacts, centre)
        answer = minimize(
            lambda load: load @ load,
            np.full(2 * contacts, 0.5 / contacts),
            jac=lambda load: 2 * load,
            bounds=[(0, 1)] * (2 * contacts),
            constraints={"type": "eq", "fun": lambda load, p=places, c=centre: p @ load - [1, *c]},
            method="SLSQP",
            options={"ftol": 1e-14, "maxiter": 500},
        )
        assert answer.success
        np.testing.assert_allclose(shares, answer.x, atol=1e-6)


@given(contacts=a_side, forward=inside, side=inside)
def test_slopes_are_the_derivative(contacts, forward, side):
    """Where a contact lifts off within the step, between the derivatives of both sides."""
    step = 1e-6
    centre = np.array([forward, side])
    for axis, e in enumerate(step * np.eye(2)):
        ends = [shares_of(contacts, centre + sign * e) for sign in (1, -1)]
        numeric = (ends[0][1] - ends[1][1]) / (2 * step)
        both = np.stack([end[2][axis] for end in ends])
        assert np.all(numeric < both.max(axis=0) + 1e-7)
        assert np.all(numeric > both.min(axis=0) - 1e-7)


def test_samples_with_different_numbers_of_contacts(rng):
    """Together as alone; the rest of a shorter sample bears nothing."""
    contacts = np.array([2, 5, 3.0000001, 2.9999999, 4])
    centres = rng.uniform(-0.9, 0.9, (2, 5))
    shares, slopes = load_shares(centres, even_layout(contacts))
    for k, count in enumerate((2, 5, 3, 3, 4)):
        _, alone, alone_slopes = shares_of(count, centres[:, k])
        present = np.r_[:count, 5 : 5 + count]
        np.testing.assert_allclose(shares[present, k], alone, atol=1e-15)
        np.testing.assert_allclose(slopes[:, present, k], alone_slopes, atol=1e-14)
        assert np.count_nonzero(shares[:, k]) <= 2 * count
