"""The search for a balance: where there is one it is found, and all answers are finite."""

import math
from dataclasses import replace

import numpy as np

from odometry.models import contact
from odometry.models.contact import Contact
from odometry.models.contact_balance import balance_at
from odometry.models.contact_solve import NEAR, descend
from odometry.models.contact_stance import stance_of
from odometry.models.inputs import Inputs
from odometry.recording.run import Robot

MODEL = Contact()
ORDINARY = MODEL.pack(MODEL.guess(Robot(0.5)))


def wide(rng, count):
    """Robots, speeds and slopes far beyond the ordinary: tipping, sliding, drifting."""
    length, width = rng.uniform(0.1, 1, (2, count))
    values = np.stack(
        [
            rng.uniform(0.05, 1.5, count),
            np.ones(count),
            rng.uniform(-0.8, 0.8, count) * length,
            rng.uniform(-0.8, 0.8, count) * width,
            rng.uniform(0, 2, count),
            length,
            width,
            rng.integers(2, 7, count),
            10 ** rng.uniform(-3, -0.5, count),
        ],
        axis=-1,
    )
    speeds = rng.uniform(-2, 2, (count, 2))
    speeds[: count // 10, 1] = speeds[: count // 10, 0]
    return values, Inputs(speeds, *rng.normal(0, 0.2, (2, count)))


def balance_of(values, inputs):
    return balance_at(stance_of(values, inputs), MODEL.twist(values, inputs).T)


def settled(balance):
    return np.abs(balance.residual).max(axis=0) < 1e-12


def test_everything_is_finite_everywhere(rng):
    """Head over heels, parked on a wall, with a centre of mass outside the base; none pulls."""
    values, inputs = wide(rng, 200)
    values[::5, 2] *= 3
    turned = Inputs(inputs.tread_speeds_m_s, *rng.uniform(-math.pi, math.pi, (2, 200)))
    for one in (inputs, turned, Inputs(np.zeros((200, 2)), turned.roll_rad, turned.pitch_rad)):
        for function in (MODEL.twist, MODEL.parameter_jacobian, MODEL.speed_jacobian):
            assert np.all(np.isfinite(function(values, one)))
        assert np.all(balance_of(values, one).load >= 0)


def test_ordinary_robots_settle(rng):
    """Every one, to 1e-12 of the weight; of those far beyond the ordinary, 99 in 100."""
    values, inputs = wide(rng, 4000)
    assert np.mean(settled(balance_of(values, inputs))) > 0.99
    tame = np.tile(ORDINARY, (4000, 1))
    tame[:, [2, 3, 7]] = rng.uniform([-0.1, -0.1, 2], [0.1, 0.1, 6], (4000, 3))
    tame[:, 0], tame[:, 8] = rng.uniform(0.4, 1, 4000), 10 ** rng.uniform(-2, -1, 4000)
    slopes = np.clip([inputs.roll_rad, inputs.pitch_rad], -0.2, 0.2)
    assert np.all(settled(balance_of(tame, Inputs(inputs.tread_speeds_m_s, *slopes))))


def test_a_longer_search_is_never_worse(rng):
    """It answers with the least residual that it met, and its size; near a balance with less."""
    stance = stance_of(*wide(rng, 300))
    start = rng.normal(0, 2, (3, 300))
    before = np.inf
    for iterations in range(1, 12):
        twist, least = descend(stance, start, iterations)
        rest = balance_at(stance, twist).residual
        rest[2] /= np.hypot(*stance.base_m)
        rest, near = np.linalg.norm(rest, axis=0), least < NEAR
        np.testing.assert_allclose(rest[~near], least[~near], rtol=1e-9)
        assert np.all(rest[near] < 1e-13)
        assert np.all(least <= before)
        before = least


def test_derivatives_where_limits_are_at_work(rng):
    """Held slopes, robots that tip and lifted contacts: all are among these, and their absence."""
    values, inputs = wide(rng, 200)
    balance = balance_of(values, inputs)
    lifted = (balance.load == 0) & (balance.stance.layout.places[0] > 0)
    for at_work in (balance.stance.held, balance.reach < 1, np.any(lifted, axis=0)):
        assert 0.1 < np.mean(at_work) < 0.9
    found, step = settled(balance), 1e-6
    by_parameter = [
        (MODEL.twist(values + e, inputs) - MODEL.twist(values - e, inputs)) / (2 * step)
        for e in step * np.eye(9)
    ]
    by_speed = [
        (
            MODEL.twist(values, replace(inputs, tread_speeds_m_s=inputs.tread_speeds_m_s + e))
            - MODEL.twist(values, replace(inputs, tread_speeds_m_s=inputs.tread_speeds_m_s - e))
        )
        / (2 * step)
        for e in step * np.eye(2)
    ]
    for columns, exact in (
        (by_parameter, MODEL.parameter_jacobian(values, inputs)),
        (by_speed, MODEL.speed_jacobian(values, inputs)),
    ):
        error = np.abs(np.stack(columns, axis=-1) - exact).max(axis=1)
        size = 0.01 + np.abs(exact).max(axis=1)
        np.testing.assert_array_less(error[found], 1e-4 * size[found])


def test_long_recordings_are_taken_in_blocks(monkeypatch, rng):
    values, inputs = wide(rng, 50)
    whole = [f(values, inputs) for f in (MODEL.twist, MODEL.parameter_jacobian)]
    monkeypatch.setattr(contact, "BLOCK", 7)
    parts = [f(values, inputs) for f in (MODEL.twist, MODEL.parameter_jacobian)]
    for one, other in zip(whole, parts, strict=True):
        np.testing.assert_allclose(one, other, rtol=1e-12, atol=1e-13)


def test_what_is_not_known_gives_no_twist():
    """NaN where a tread speed or an angle is NaN, and nowhere else."""
    speeds = np.array([[0.1, 0.5], [np.nan, 0.5], [0.1, 0.5], [0.1, 0.5]])
    roll, pitch = np.array([[0, 0, np.nan, 0.1], [0.1, 0, 0, 0]])
    seen = MODEL.twist(ORDINARY, Inputs(speeds, roll, pitch))
    np.testing.assert_array_equal(np.isnan(seen), np.repeat([[0], [1], [1], [0]], 3, axis=1))


def test_no_samples():
    assert MODEL.twist(ORDINARY, Inputs(np.zeros((0, 2)))).shape == (0, 3)


def test_a_search_from_a_known_balance_finds_the_same_one(rng):
    """Ordinary robots, from the balance with other friction and longer contacts."""
    values, inputs = np.tile(ORDINARY, (500, 1)), wide(rng, 500)[1]
    slopes = np.clip([inputs.roll_rad, inputs.pitch_rad], -0.2, 0.2)
    inputs = Inputs(np.clip(inputs.tread_speeds_m_s, -0.6, 0.6), *slopes)
    other = values * np.where(np.arange(9) == 0, 1.2, np.where(np.arange(9) == 5, 0.8, 1.0))
    near = MODEL.twist_near(values, inputs, MODEL.twist(other, inputs))
    np.testing.assert_allclose(near, MODEL.twist(values, inputs), atol=1e-9)


def test_a_search_from_far_away_settles_as_often_as_an_ordinary_one(rng):
    """Where it does not settle from there, it begins where it would have."""
    values, inputs = wide(rng, 1000)
    near = MODEL.twist_near(values, inputs, rng.normal(0, 50, (1000, 3)))
    of_near = settled(balance_at(stance_of(values, inputs), near.T))
    assert np.all(of_near[settled(balance_of(values, inputs))])
