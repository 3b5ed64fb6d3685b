"""What the states of an IMM must do; its recursion: tests/reference."""

from dataclasses import replace

import numpy as np
import pytest

from odometry.estimation.imm.ekf_bank import EkfBank
from odometry.estimation.imm.estimator import Imm, Members
from odometry.estimation.imm.markov import ModeChain
from odometry.estimation.imm.mode_belief import ModeBelief
from tests.odometry.estimation.imm.ekf_member import EkfMember
from tests.odometry.estimation.imm.imm_banks import (
    EVEN,
    LEANING,
    NOTHING,
    pose_model,
    two_rates,
)


def drive(rng, steps=100):
    """Speeds, measured poses (now and then in part, or not at all) and steps."""
    truth = np.array([0.0, 0.0, 3.0])
    for step in range(steps):
        u, step_s = np.array([1.0, 2.0]) + rng.normal(size=2), rng.uniform(0.02, 0.1)
        truth = truth + np.array([np.cos(truth[2]), np.sin(truth[2]), u[1]]) * step_s
        z = truth + rng.normal(size=3) * [0.02, 0.02, 0.01]
        z[2] = np.angle(np.exp(1j * z[2]))
        if step % 7 == 3:
            z[:2] = np.nan
        yield u, None if step % 5 == 2 else z, step_s


def plain_ekf(model, rng):
    """Means and covariances of the filter alone after each step of `drive`."""
    member = EkfMember(model)
    mean, covariance = np.array([0.0, 0.0, 3.0]), 0.01 * np.eye(3)
    for u, z, step_s in drive(rng):
        mean, covariance = member.predicted(mean, covariance, u, step_s)
        if z is not None:
            mean, covariance, *_ = member.updated(mean, covariance, z)
        yield mean, covariance


def imm_beliefs(imm, probabilities, rng):
    belief = ModeBelief.alike(np.array([0.0, 0.0, 3.0]), 0.01 * np.eye(3), np.array(probabilities))
    for u, z, step_s in drive(rng):
        belief = imm.step(belief, u, z, step_s)
        yield belief


def test_one_mode_is_the_plain_filter_to_the_last_bit():
    model = pose_model(0.8, 0.7)
    imm = Imm(Members((EkfMember(model),)), ModeChain(np.ones(1)).transition, state_angles=(2,))
    beliefs = imm_beliefs(imm, [1.0], np.random.default_rng(3))
    for belief, (mean, covariance) in zip(
        beliefs, plain_ekf(model, np.random.default_rng(3)), strict=True
    ):
        np.testing.assert_array_equal(belief.means[0], mean)
        np.testing.assert_array_equal(belief.covariances[0], covariance)
        np.testing.assert_array_equal(imm.merged(belief)[0], mean)
        assert belief.log_probabilities[0] == 0


def test_equal_modes_are_the_plain_filter_and_distinguish_nothing():
    model = pose_model(0.8, 0.7)
    bank = EkfBank(pose_model(np.full(3, 0.8), np.full(3, 0.7)), 3)
    imm = Imm(bank, ModeChain(np.full(3, 2.0)).transition, state_angles=(2,))
    beliefs = imm_beliefs(imm, [0.5, 0.3, 0.2], np.random.default_rng(3))
    for belief, (mean, covariance) in zip(
        beliefs, plain_ekf(model, np.random.default_rng(3)), strict=True
    ):
        merged, spread = imm.merged(belief)
        np.testing.assert_allclose(np.exp(1j * merged), np.exp(1j * mean), atol=1e-12)
        np.testing.assert_allclose(spread, covariance, atol=1e-14)
        assert belief.probabilities[0] > belief.probabilities[1] > belief.probabilities[2]
    np.testing.assert_allclose(belief.probabilities, 1 / 3, atol=0.02)


def test_the_order_of_modes_is_of_no_account():
    k, m, dwell_s = np.array([[0.9, 0.5, 0.7, 0.3], [0.9, 0.6, 0.2, 0.5], [1, 2, 3, 4]])
    start, order = np.array([0.1, 0.2, 0.3, 0.4]), [2, 0, 3, 1]
    ends = []
    for places in (slice(None), order):
        bank = EkfBank(pose_model(k[places], m[places]), 4)
        imm = Imm(bank, ModeChain(dwell_s[places]).transition, state_angles=(2,))
        *_, end = imm_beliefs(imm, start[places], np.random.default_rng(3))
        ends.append((end, imm.merged(end)))
    (one, merged), (other, merged_other) = ends
    np.testing.assert_allclose(one.means[order], other.means, atol=1e-10)
    np.testing.assert_allclose(one.covariances[order], other.covariances, atol=1e-12)
    np.testing.assert_allclose(
        one.log_probabilities[order], other.log_probabilities, rtol=1e-9, atol=1e-9
    )
    np.testing.assert_allclose(merged[0], merged_other[0], atol=1e-10)


def test_headings_are_mixed_round_the_circle():
    """3.1 and -3.1 start the filters at pi, where linear means (filterpy's) would say 0."""
    bank = EkfBank(pose_model(np.ones(2), np.ones(2)), 2)
    imm = Imm(bank, lambda _: np.full((2, 2), 0.5), state_angles=(2,))
    means = np.array([[0, 0, 3.1], [0, 0, -3.1]])
    belief = ModeBelief(means, np.tile(1e-4 * np.eye(3), (2, 1, 1)), np.log([0.5, 0.5]))
    mixed = imm.step(belief, np.zeros(2), None, 0.0)
    np.testing.assert_allclose(np.abs(mixed.means[:, 2]), np.pi, atol=1e-12)
    np.testing.assert_allclose(mixed.covariances[:, 2, 2], 1e-4 + (np.pi - 3.1) ** 2, atol=1e-12)
    assert abs(imm.merged(belief)[0][2]) == pytest.approx(np.pi)
    opposite = replace(belief, means=np.array([[0, 0, 0.5], [0, 0, 0.5 - np.pi]]))
    assert imm.merged(opposite)[0][2] == pytest.approx(0.5)


def test_a_step_is_prediction_and_update():
    imm, belief = two_rates(LEANING)
    predicted = imm.predicted(belief, NOTHING, 0.1)
    np.testing.assert_allclose(predicted.probabilities, [0.65, 0.35])
    updated, at_once = (
        imm.updated(predicted, np.ones(1)),
        imm.step(belief, NOTHING, np.ones(1), 0.1),
    )
    np.testing.assert_array_equal(updated.means, at_once.means)
    np.testing.assert_array_equal(updated.log_probabilities, at_once.log_probabilities)


def test_input_stays():
    imm = Imm(EkfBank(pose_model(np.ones(2), np.ones(2)), 2), lambda _: np.array(EVEN), (2,))
    parts = np.array([[0, 0, 3.1], [0, 0, -3.1]]), np.tile(np.eye(3), (2, 1, 1)), np.log([0.4, 0.6])
    z = np.array([0.1, np.nan, 3.0])
    copies = [np.array(each) for each in (*parts, z)]
    imm.step(ModeBelief(*parts), np.ones(2), z, 0.1)
    for one, copy in zip((*parts, z), copies, strict=True):
        np.testing.assert_array_equal(one, copy)
