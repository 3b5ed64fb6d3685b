"""Filters of one mode each, when the lead among the modes changes."""

import numpy as np
from hypothesis import given
from hypothesis import strategies as st

from odometry.estimation.imm.mode_belief import ModeBelief
from odometry.modes.follow.tempered_bank import with_lead, with_shared_bias

LOGS = np.log([0.1, 0.9])
ALONE = ModeBelief(np.array([[1.0], [50.0]]), np.array([[[1.0]], [[2.0]]]), LOGS)
ALL = ModeBelief(np.array([[3.0], [4.0]]), np.array([[[5.0]], [[6.0]]]), LOGS)


def test_a_mode_that_takes_the_lead_begins_where_the_estimator_is():
    begun = with_lead(ALONE, ALL, led=0)
    np.testing.assert_array_equal(begun.means, [[1.0], [4.0]])
    np.testing.assert_array_equal(begun.covariances, [[[1.0]], [[6.0]]])


def test_a_mode_that_keeps_the_lead_goes_on():
    assert with_lead(ALONE, ALL, led=1) is ALONE


def random_belief(seed):
    rng = np.random.default_rng(seed)
    roots = rng.normal(size=(3, 4, 4))
    logs = np.log(rng.dirichlet(np.ones(3)))
    return ModeBelief(rng.normal(size=(3, 4)), roots @ roots.swapaxes(1, 2), logs)


def given_bias(mean, covariance, bias):
    """Mean and covariance of the other entries given the last one."""
    slope = covariance[:-1, -1] / covariance[-1, -1]
    left = covariance[:-1, :-1] - np.outer(slope, covariance[:-1, -1])
    return mean[:-1] + slope * (bias - mean[-1]), left


@given(st.integers(0, 2**32 - 1), st.floats(0.01, 1.0))
def test_modes_share_a_bias_and_what_they_say_given_it_stays(seed, independent):
    """Its variance is that of the mixture, what means differ by scaled as filters hold it."""
    belief = random_belief(seed)
    shared = with_shared_bias(belief, independent)
    weights, biases = belief.probabilities, belief.means[:, -1]
    second = weights @ (belief.covariances[:, -1, -1] + independent * biases**2)
    variance = second - independent * (weights @ biases) ** 2
    np.testing.assert_allclose(shared.means[:, -1], weights @ biases, atol=1e-12)
    np.testing.assert_allclose(shared.covariances[:, -1, -1], variance, rtol=1e-9)
    for mode in range(3):
        before = given_bias(belief.means[mode], belief.covariances[mode], 0.3)
        after = given_bias(shared.means[mode], shared.covariances[mode], 0.3)
        for a, b in zip(before, after, strict=True):
            np.testing.assert_allclose(a, b, rtol=1e-7, atol=1e-7)


def test_one_mode_keeps_its_bias():
    one = ModeBelief(np.array([[1.0, 2.0]]), np.array([[[2.0, 0.5], [0.5, 1.0]]]), np.zeros(1))
    shared = with_shared_bias(one, 0.1)
    np.testing.assert_allclose(shared.means, one.means)
    np.testing.assert_allclose(shared.covariances, one.covariances)


def test_a_bias_that_is_known_stays():
    means = np.array([[1.0, 0.1], [3.0, 0.1]])
    covariances = np.tile(np.diag([2.0, 0.0]), (2, 1, 1))
    shared = with_shared_bias(ModeBelief(means, covariances, np.log([0.5, 0.5])), 0.1)
    np.testing.assert_array_equal(shared.means, means)
    np.testing.assert_array_equal(shared.covariances, covariances)
