import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from scipy.stats import binom

from terrain.classification.neighbours.calibration import (
    FLOOR,
    fitted_temperature,
    reliability,
    reliability_by_chance,
    tempered,
)


@given(st.lists(st.floats(0.001, 1), min_size=2, max_size=6), st.floats(0.1, 10))
def test_a_temperature_keeps_the_order_and_the_sum(raw, temperature):
    votes = np.array([raw]) / np.sum(raw)
    given_ = tempered(votes, temperature)
    assert given_.sum() == pytest.approx(1)
    order = np.argsort(votes[0])
    assert np.all(np.diff(given_[0, order]) >= 0)


def test_no_temperature_leaves_votes_as_they_are(rng):
    votes = rng.dirichlet(np.ones(3), 5)
    assert tempered(votes, None) is votes


def test_the_temperature_of_votes_that_are_too_sure_is_found(rng):
    """Codes drawn from probabilities; votes are their square: the temperature is 2."""
    votes = rng.dirichlet(np.ones(4), 20_000)
    true = tempered(votes, 2.0)
    codes = (rng.random(len(true))[:, None] > true.cumsum(axis=1)).sum(axis=1)
    assert fitted_temperature(codes, votes) == pytest.approx(2.0, rel=0.05)
    found = reliability(codes, tempered(votes, 2.0)).expected_error
    assert found < 0.02 < reliability(codes, votes).expected_error


def test_expected_error_in_closed_form():
    probabilities = np.array([[0.95, 0.05]] * 4 + [[0.35, 0.65]] * 2)
    found = reliability(np.array([0, 0, 0, 1, 1, 0]), probabilities)
    assert found.counts.tolist() == [0, 0, 0, 0, 0, 0, 2, 0, 0, 4]
    assert found.accuracies[[6, 9]].tolist() == [0.5, 0.75]
    assert found.expected_error == pytest.approx((2 * 0.15 + 4 * 0.20) / 6)
    assert found.mean_excess == pytest.approx((2 * 0.15 + 4 * 0.20) / 6)
    turned = reliability(np.array([0, 0, 0, 0, 1, 1]), probabilities)
    assert turned.mean_excess == pytest.approx(-(2 * 0.35 + 4 * 0.05) / 6)


def test_a_class_without_a_neighbour_stays_possible():
    given_ = tempered(np.array([[1.0, 0.0]]), 1.0)
    assert given_[0, 1] == pytest.approx(FLOOR / (1 + 2 * FLOOR))


def test_the_error_of_exact_probabilities_in_closed_form():
    """n answers of one probability p: the mean of |share right - p| over the binomial."""
    n, p = 12, 0.75
    shares = np.arange(n + 1)
    expected = binom(n, p).pmf(shares) @ np.abs(shares / n - p)
    probabilities = np.tile([p, 1 - p], (n, 1))
    found = reliability_by_chance(probabilities, np.arange(n)).expected_error
    assert found == pytest.approx(expected, abs=4 * 0.125 * 0.6 / np.sqrt(200))
    together = reliability_by_chance(probabilities, np.zeros(n)).expected_error
    assert together == pytest.approx(2 * p * (1 - p), abs=4 * 0.22 / np.sqrt(200))


def test_exact_probabilities_are_no_farther_off_than_expected(rng):
    probabilities = rng.dirichlet(np.ones(4), 3000)
    codes = (rng.random(3000)[:, None] > probabilities.cumsum(axis=1)).sum(axis=1)
    expected = reliability_by_chance(probabilities, np.arange(3000)).expected_error
    assert reliability(codes, probabilities).expected_error < 2 * expected < 0.04


def test_shares_that_chance_explains_are_those_of_the_binomial():
    """400 answers of one probability: a band of two deviations on either side, no other tenth."""
    n, p = 400, 0.75
    chance = reliability_by_chance(np.tile([p, 1 - p], (n, 1)), np.arange(n))
    expected = binom(n, p).ppf([0.025, 0.975]) / n
    assert [chance.lowest[7], chance.highest[7]] == pytest.approx(expected, abs=0.012)
    assert np.isnan(np.delete(chance.lowest, 7)).all()
