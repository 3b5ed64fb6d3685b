"""Steady states against root finding, least dissipation and closed forms."""

import numpy as np
import pytest
from scipy.optimize import minimize, root

from odometry.simulation.contact.steady_state import steady_state

G = 9.80665
PAIRS = np.array([[-0.4, 0.5], [0.3, 0.9], [0.9, 0.2], [-0.8, -0.3], [0.0, 0.6]])
ARMS = np.array([[x, y] for y in (0.4, -0.4) for x in (-0.45, 0.1, 0.4)])
MASS_CENTRE = np.array([0.05, -0.03])


def slips_at(twist, pair):
    """Velocity of the tread over the ground at each contact (6, 2)."""
    v_x, v_y, omega = twist
    treads = np.repeat(pair, 3)
    return np.column_stack([v_x - omega * ARMS[:, 1] - treads, v_y + omega * ARMS[:, 0]])


def residual(twist, pair, law, tilt):
    """Force and moment that are left over, by real vectors, from the twist alone.

    With loads by least squares (all contacts carry here), and the shear displacement as the root
    of slip = (renewal + |slip| / J) j; a track renews its tread from the leading edge.
    """
    roll, pitch = tilt
    g_x, g_y = G * np.sin(pitch), -G * np.cos(pitch) * np.sin(roll)
    v_x, v_y, omega = twist
    centre = np.array([v_x - omega * MASS_CENTRE[1], v_y + omega * MASS_CENTRE[0]])
    needed = 120 * (omega * np.array([-centre[1], centre[0]]) - [g_x, g_y])
    weight = 120 * G * np.cos(pitch) * np.cos(roll)
    balance = np.column_stack([np.ones(6), ARMS])
    right = np.array([weight, *(weight * MASS_CENTRE - 0.3 * needed)])
    loads = balance @ np.linalg.solve(balance.T @ balance, right)
    assert loads.min() > 0
    slips = slips_at(twist, pair)
    speeds = np.linalg.norm(slips, axis=1)
    if law == "coulomb":
        push = slips / np.hypot(speeds, 0.005)[:, None]
    else:
        treads = np.repeat(pair, 3)
        entry = 0.6 - np.sign(treads) * ARMS[:, 0] if law == "track" else 0.05
        j = slips / (np.abs(treads) / entry + speeds / 0.03)[:, None]
        size = np.linalg.norm(j, axis=1)
        push = ((1 - np.exp(-size / 0.006)) / size)[:, None] * j
    forces = -0.6 * loads[:, None] * push
    arms = ARMS - MASS_CENTRE
    moment = (arms[:, 0] * forces[:, 1] - arms[:, 1] * forces[:, 0]).sum()
    return [*(forces.sum(axis=0) - needed) / 100, moment / 50]


@pytest.mark.parametrize("law", ["coulomb", "shear", "track"])
@pytest.mark.parametrize("tilt", [(0.0, 0.0), (0.08, -0.05)])
def test_steady_states_are_roots_of_the_balance(make_vehicle, law, tilt):
    track = {"patch_length": None, "track_length": 1.2}
    vehicle = make_vehicle("shear", **track) if law == "track" else make_vehicle(law)
    twists, settled = steady_state(vehicle, PAIRS, roll_rad=tilt[0], pitch_rad=tilt[1])
    assert settled.all()
    for pair, twist in zip(PAIRS, twists, strict=True):
        np.testing.assert_allclose(residual(twist, pair, law, tilt), 0.0, atol=2e-5)
        found = root(residual, twist + 0.01, (pair, law, tilt), tol=1e-12)
        np.testing.assert_allclose(found.x, twist, atol=1e-5)


def test_slow_turns_dissipate_the_least(make_vehicle):
    """At fixed loads and no inertia Coulomb friction minimises sum mu N sqrt(s^2 + eps^2)."""
    pairs = 0.02 * PAIRS
    twists, _ = steady_state(make_vehicle(rounding=0.001), pairs)
    balance = np.column_stack([np.ones(6), ARMS])
    loads = balance @ np.linalg.solve(balance.T @ balance, 120 * G * np.array([1, *MASS_CENTRE]))

    def power(twist, pair):
        return (loads * np.sqrt((slips_at(twist, pair) ** 2).sum(axis=1) + 1e-6)).sum()

    for pair, twist in zip(pairs, twists, strict=True):
        least = minimize(power, np.zeros(3), (pair,), method="BFGS", options={"gtol": 1e-7}).x
        np.testing.assert_allclose(twist, least, atol=2e-5)


@pytest.mark.parametrize("law", ["coulomb", "shear"])
def test_a_mirrored_vehicle_turns_the_other_way(make_vehicle, law):
    left = {"friction_left": [0.4, 0.5, 0.6], "friction_right": [0.7, 0.6, 0.5], "friction": None}
    right = {"friction_left": left["friction_right"], "friction_right": left["friction_left"]}
    one, _ = steady_state(make_vehicle(law, **left), PAIRS, roll_rad=0.1, pitch_rad=0.05)
    other, _ = steady_state(
        make_vehicle(law, **{**left, **right}, y_cm=0.03),
        PAIRS[:, ::-1],
        roll_rad=-0.1,
        pitch_rad=0.05,
    )
    np.testing.assert_allclose(other, one * [1, -1, -1], atol=1e-6)


def test_straight_driving_on_a_side_slope(make_vehicle):
    """tan(b) = mu s / sqrt(s^2 + eps^2), and 1 - exp(-j / K) = tan(b) / mu by shear."""
    tilt, straight = 0.1, np.array([[0.5, 0.5]])
    symmetric = {"x_cm": 0.0, "y_cm": 0.0, "places": [-0.4, 0.4]}
    share = np.tan(tilt) / 0.6
    twist, _ = steady_state(make_vehicle(**symmetric), straight, roll_rad=tilt)
    drift = 0.005 * share / np.sqrt(1 - share**2)
    np.testing.assert_allclose(twist[0], [0.5, -drift, 0.0], atol=1e-7)
    vehicle = make_vehicle("shear", **symmetric)
    twist, _ = steady_state(vehicle, straight, roll_rad=tilt)
    j = -0.006 * np.log(1 - share)
    drift = j * (0.5 / 0.05) / (1 - j / vehicle.law.longest_m)
    np.testing.assert_allclose(twist[0], [0.5, -drift, 0.0], atol=1e-6)


def test_turning_downhill_slides_downhill(make_vehicle):
    """data/README.md: pitch > 0 has the nose down, so that gravity pushes forward."""
    spin = np.array([[-0.3, 0.3]] * 5)
    roll, pitch = np.array([0, 0, 0, 0.1, -0.1]), np.array([0, 0.1, -0.1, 0, 0])
    twists, _ = steady_state(make_vehicle("shear"), spin, roll_rad=roll, pitch_rad=pitch)
    moved = twists[1:] - twists[0]
    assert moved[0, 0] > 0.02
    assert moved[1, 0] < -0.02
    assert moved[2, 1] < -0.02
    assert moved[3, 1] > 0.02


def test_what_has_not_settled_is_reported(make_vehicle):
    _, settled = steady_state(make_vehicle("shear"), PAIRS, longest_s=0.5)
    assert not settled.any()
