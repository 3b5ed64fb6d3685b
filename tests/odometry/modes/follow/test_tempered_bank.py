"""A tempered bank: likelihoods to a power, bounded for outliers, and nothing else."""

import numpy as np
import pytest

from odometry.estimation.imm.ekf_bank import EkfBank
from odometry.estimation.imm.mode_belief import ModeBelief
from odometry.modes.follow.tempered_bank import TemperedBank, with_bias
from tests.odometry.modes.mode_examples import velocity_set


@pytest.mark.parametrize("independent", [0.0, 0.25, 1.0])
def test_log_likelihoods_are_scaled_and_the_rest_is_that_of_the_bank(independent):
    bank = EkfBank(velocity_set().modes.model(), 2)
    tempered = TemperedBank(bank, independent)
    means = np.array([[0.5, 0.1, 0.01], [0.4, -0.2, 0.02]])
    covariances = np.tile(0.1 * np.eye(3), (2, 1, 1))
    u, z = np.array([0.3, 0.6]), np.array([0.5, 0.25])
    before, same = (one.predicted(means, covariances, u, 0.1) for one in (bank, tempered))
    for plain, own in zip(before, same, strict=True):
        np.testing.assert_array_equal(plain, own)
    plain, own = (one.updated(*before, z) for one in (bank, tempered))
    for place in (1, 3):
        np.testing.assert_array_equal(plain[place], own[place])
    np.testing.assert_allclose(own[0], plain[0], rtol=1e-12)
    assert plain[3].max() < 4.0
    # a Gaussian of 99.9 %, and the rest with tails of a power of 3 in two dimensions
    rest = 0.001 * np.exp(plain[3] / 2) / (1 + plain[3]) ** 1.5
    np.testing.assert_allclose(own[2], independent * (plain[2] + np.log(0.999 + rest)))
    assert tempered.modes == 2


def test_an_absurd_sample_says_next_to_nothing_and_moves_next_to_nothing():
    bank = EkfBank(velocity_set().modes.model(), 2)
    tempered = TemperedBank(bank, 1.0)
    means, covariances = np.zeros((2, 3)), np.tile(1e-4 * np.eye(3), (2, 1, 1))
    means[1, 1] = 0.1  # two standard deviations apart
    z = np.array([np.nan, 300.0])
    plain, own = (one.updated(means, covariances, z) for one in (bank, tempered))
    assert abs(np.diff(plain[2])[0]) > 1e4
    assert abs(np.diff(own[2])[0]) < 0.01
    pull = 5.0 / np.sqrt(own[3])
    np.testing.assert_allclose(own[0] - means, pull[:, None] * (plain[0] - means), rtol=1e-9)
    assert np.abs(own[0] - means).max() < 0.02


def test_all_modes_take_the_bias_of_one_estimate_and_keep_the_rest():
    covariances = np.tile(0.1 + np.diag([0.1, 0.2, 0.3]), (2, 1, 1))
    belief = ModeBelief(np.arange(6.0).reshape(2, 3), covariances, np.log([0.4, 0.6]))
    covariance = np.diag([7.0, 8.0, 9.0]) + 0.5
    given = with_bias(belief, np.array([5.0, 6.0, 0.02]), covariance)
    np.testing.assert_array_equal(given.means, [[0.0, 1.0, 0.02], [3.0, 4.0, 0.02]])
    np.testing.assert_array_equal(given.covariances[:, :2, :2], covariances[:, :2, :2])
    np.testing.assert_array_equal(given.covariances[:, 2], [[0.0, 0.0, 9.5]] * 2)
    np.testing.assert_array_equal(given.covariances[:, :, 2], [[0.0, 0.0, 9.5]] * 2)
    np.testing.assert_array_equal(given.log_probabilities, belief.log_probabilities)
