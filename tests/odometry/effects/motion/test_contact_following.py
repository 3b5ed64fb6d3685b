"""A robot that follows the balance of its contacts late, beside Newton's equations integrated."""

from dataclasses import replace

import numpy as np

from odometry.effects.motion.contact_effects import followed
from odometry.models.catalogue import MODELS
from odometry.models.contact_balance import balance_at
from odometry.models.contact_stance import stance_of
from odometry.models.inputs import Inputs

G_M_S2 = 9.80665
X_CM, Y_CM, HALF_LENGTH, HALF_WIDTH = 0.04, 0.02, 0.3, 0.25
VALUES = np.array([0.6, 1.0, X_CM, Y_CM, 0.15, HALF_LENGTH, HALF_WIDTH, 2.0, 0.02])
STEP_S = 0.02


def inputs_of(speeds):
    return Inputs(np.asarray(speeds), time_s=STEP_S * np.arange(len(speeds)))


def balanced(inputs):
    return MODELS["contact"].twist(VALUES, inputs)


def speeding_up_in_turns(count=150):
    """Half a second at even speeds, then treads that change theirs by up to 1 m/s^2."""
    time_s = np.maximum(STEP_S * np.arange(count) - 0.5, 0.0)
    return np.stack([0.5 + 0.3 * np.sin(2 * time_s), 1.0 + 0.4 * np.sin(2.5 * time_s)], axis=-1)


def rate_of(twist, tread_speeds):
    """Of the twist: Newton and Euler with all forces, loads shifted by the acceleration too."""
    stance = stance_of(VALUES[None], Inputs(tread_speeds[None]))
    pushed = np.zeros(2)  # acceleration of the centre of mass
    for _ in range(12):
        felt = replace(stance, gravity=-pushed[:, None] / G_M_S2)
        balance = balance_at(felt, twist[:, None])
        along, across, moment = balance.friction[:, 0] * G_M_S2
        turn = (moment - X_CM * across + Y_CM * along) / ((HALF_LENGTH**2 + HALF_WIDTH**2) / 3)
        centrifugal = (balance.pull[:, 0] + pushed / G_M_S2) * G_M_S2
        pushed = np.array([along, across]) + centrifugal
    return np.array([pushed[0] + Y_CM * turn, pushed[1] - X_CM * turn, turn])


def integrated(speeds, start, parts=4):
    """The mean twist (N, 3) of each sample, by the midpoint rule."""
    twist, means = start, []
    for row in speeds:
        begin = twist
        for _ in range(parts):
            halfway = twist + rate_of(twist, row) * STEP_S / parts / 2
            twist = twist + rate_of(halfway, row) * STEP_S / parts
        means.append((begin + twist) / 2)
    return np.array(means)


def test_it_follows_as_newton_and_euler_say():
    """To first order: most of the error of the balance while speeds change."""
    inputs = inputs_of(speeding_up_in_turns())
    balance = balanced(inputs)
    truth = integrated(inputs.tread_speeds_m_s, balance[0])
    late = np.abs(truth - balance).max(axis=0)
    left = np.abs(truth - followed(VALUES, inputs, balance)).max(axis=0)
    assert (late > 0.015).all()
    assert (left < [0.1, 0.15, 0.4] * late).all()


def test_at_even_speed_the_balance_is_reached():
    inputs = inputs_of([[0.3, 1.0]] * 5 + [[0.5, 0.8]] * 300)
    balance = balanced(inputs)
    found = followed(VALUES, inputs, balance)
    np.testing.assert_array_equal(found[:5], balance[:5])
    assert np.abs(found[5] - balance[5]).max() > 0.05
    np.testing.assert_allclose(found[-1], balance[-1], atol=1e-6)


def test_a_record_begins_in_balance_and_so_does_all_without_stamps():
    speeds = np.array([[0.3, 1.0]] * 5 + [[0.5, 0.8]] * 5)
    time_s = STEP_S * np.arange(10) + np.repeat([0.0, 60.0], 5)
    for stamps_s in (time_s, None):
        inputs = Inputs(speeds, time_s=stamps_s)
        balance = balanced(inputs)
        np.testing.assert_array_equal(followed(VALUES, inputs, balance), balance)


def test_a_robot_about_to_tip_over_gains_no_energy(rng):
    """Loads that shift beyond the base push the derivative of the forces away from the balance."""
    values = np.where(np.isin(np.arange(9), [0, 4]), [0.9, *[0.0] * 3, 0.6, *[0.0] * 4], VALUES)
    inputs = inputs_of(np.repeat(rng.uniform(-3.0, 3.0, (40, 2)), 10, axis=0))
    balance = MODELS["contact"].twist(values, inputs)
    behind = followed(values, inputs, balance) - balance
    assert np.abs(behind).max() < 2 * np.ptp(balance, axis=0).max()
