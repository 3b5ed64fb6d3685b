import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from odometry.estimation.imm.mode_belief import floored, log_sum, moments

seeds = st.integers(0, 2**32 - 1)


def random_mixture(seed, modes=4, size=3):
    rng = np.random.default_rng(seed)
    weights = rng.dirichlet(np.ones(modes), size=5)
    roots = rng.normal(size=(modes, size, size))
    return weights, rng.normal(size=(modes, size)), roots @ roots.swapaxes(1, 2)


@given(seeds)
def test_moments_are_those_of_many_samples_in_the_limit(seed):
    """Sum over modes of w E[x] and w E[x x'] less the product of means: without deviations."""
    weights, means, covariances = random_mixture(seed)
    mixed, spread = moments(weights, means, covariances)
    for k, w in enumerate(weights):
        mean = sum(w[i] * means[i] for i in range(4))
        second = sum(w[i] * (covariances[i] + np.outer(means[i], means[i])) for i in range(4))
        np.testing.assert_allclose(mixed[k], mean, rtol=0, atol=1e-12)
        np.testing.assert_allclose(spread[k], second - np.outer(mean, mean), atol=1e-11)


def test_headings_on_both_sides_of_the_cut_have_their_mean_between():
    """3.1 and -3.1 are 0.083 apart: their mean is pi, their spread 0.0416."""
    means = np.array([[1.0, 3.1], [3.0, -3.1]])
    mixed, spread = moments(np.full((1, 2), 0.5), means, np.zeros((2, 2, 2)), (1,))
    half = np.pi - 3.1
    np.testing.assert_allclose(mixed, [[2.0, np.pi]], atol=1e-12)
    np.testing.assert_allclose(spread[0], [[1.0, half], [half, half**2]], atol=1e-12)


def test_headings_given_beyond_half_a_turn_have_their_mean_within_it():
    means = np.array([[5.0], [5.2]])
    mixed, spread = moments(np.full((1, 2), 0.5), means, np.zeros((2, 1, 1)), (0,))
    np.testing.assert_allclose(mixed, [[5.1 - 2 * np.pi]], atol=1e-12)
    np.testing.assert_allclose(spread, [[[0.01]]], atol=1e-12)


@pytest.mark.parametrize("heavier", [0.4, 0.6])
def test_mean_headings_lie_in_their_range(heavier):
    """3.1 and -3.0 have their mean beyond pi, on whichever side the heavier one is."""
    mixed, _ = moments(
        np.array([[heavier, 1 - heavier]]), np.array([[3.1], [-3.0]]), np.zeros((2, 1, 1)), (0,)
    )
    expected = -np.pi + (1 - heavier) * (2 * np.pi - 6.1) - (np.pi - 3.1)
    assert mixed[0, 0] == pytest.approx(expected, abs=1e-4)


@given(seeds, st.floats(-10, 10))
def test_turning_all_headings_turns_their_mean(seed, angle):
    weights, means, covariances = random_mixture(seed)
    mixed, spread = moments(weights, means, covariances, (0, 2))
    turned, turned_spread = moments(
        weights, means + np.array([angle, 0, angle]), covariances, (0, 2)
    )
    difference = turned - mixed - [angle, 0, angle]
    difference[:, [0, 2]] = np.angle(np.exp(1j * difference[:, [0, 2]]))
    np.testing.assert_allclose(difference, 0, atol=1e-9)
    np.testing.assert_allclose(turned_spread, spread, atol=1e-9)


@given(seeds, st.floats(1e-5, 1e-3))
def test_headings_close_together_mix_as_numbers(seed, size):
    """The two differ by the third power of their spread."""
    weights, means, covariances = random_mixture(seed)
    means = means * size
    linear, on_circle = (moments(weights, means, covariances, a)[0] for a in ((), (2,)))
    np.testing.assert_allclose(on_circle, linear, rtol=0, atol=10 * np.abs(means).max() ** 3)


def test_headings_that_cancel_give_the_heaviest():
    means = np.array([[0.3], [0.3 + np.pi]])
    mixed, spread = moments(np.full((1, 2), 0.5), means, np.zeros((2, 1, 1)), (0,))
    assert mixed[0, 0] == pytest.approx(0.3)
    assert spread[0, 0, 0] == pytest.approx(np.pi**2 / 2)


def test_input_stays():
    weights, means, covariances = random_mixture(1)
    copies = [np.array(each) for each in (weights, means, covariances)]
    moments(weights, means, covariances, (0,))
    for each, copy in zip((weights, means, covariances), copies, strict=True):
        np.testing.assert_array_equal(each, copy)


@given(st.lists(st.floats(-60, 0), min_size=1, max_size=8), st.floats(0.001, 0.99))
def test_a_floor_holds_and_keeps_proportions_above_it(logs, share):
    floor = share / len(logs)
    given_p = np.exp(logs) / np.exp(logs).sum()
    result = np.exp(floored(np.array(logs), floor))
    assert result.sum() == pytest.approx(1, abs=1e-12)
    assert np.all(result >= floor * (1 - 1e-12))
    above = result > floor * (1 + 1e-9)
    if above.any():
        ratios = result[above] / given_p[above]
        np.testing.assert_allclose(ratios, ratios[0], rtol=1e-9)
        assert ratios[0] <= 1 + 1e-12
    assert np.all(given_p[~above] <= floor * (1 + 1e-9) / (ratios[0] if above.any() else 1))


def test_a_floor_that_pushes_another_below_it_still_holds():
    """Two are lifted to 0.2; what is left would put 0.2002 at 0.15: it is lifted as well."""
    p = np.exp(floored(np.log([0.5996, 0.2002, 0.1998, 0.0004]), 0.2))
    np.testing.assert_allclose(p, [0.4, 0.2, 0.2, 0.2], atol=1e-12)


def test_above_the_floor_nothing_changes():
    logs = np.log([0.5, 0.3, 0.2])
    np.testing.assert_allclose(floored(logs - 1000, 0.01), logs, atol=1e-12)


def test_logarithms_of_nothing_and_of_the_very_small():
    assert log_sum(np.array([-np.inf, -np.inf])) == -np.inf
    assert log_sum(np.array([-18.9e6, -6.1e6])) == -6.1e6
    np.testing.assert_allclose(np.exp(floored(np.array([-18.9e6, -6.1e6]), 1e-6)), [1e-6, 1 - 1e-6])
    np.testing.assert_array_equal(floored(np.array([-np.inf, 0.0]), 0.0), [-np.inf, 0.0])
    np.testing.assert_allclose(np.exp(floored(np.array([-np.inf, 0.0]), 0.1)), [0.1, 0.9])
