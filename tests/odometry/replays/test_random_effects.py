"""The spread between runs, against published figures and drawn runs."""

import numpy as np
import pytest
from scipy.stats import norm

from odometry.replays.random_effects import (
    between_run_variance,
    dissent,
    largest_between_run_variance,
)

# Thirteen trials of the BCG vaccine (Colditz et al. 1994): cases and others, treated and not.
BCG = np.array(
    [
        *([4, 119, 11, 128], [6, 300, 29, 274], [3, 228, 11, 209], [62, 13536, 248, 12619]),
        *([33, 5036, 47, 5761], [180, 1361, 372, 1079], [8, 2537, 10, 619]),
        *([505, 87886, 499, 87892], [29, 7470, 45, 7232], [17, 1699, 65, 1600]),
        *([186, 50448, 141, 27197], [5, 2493, 3, 2338], [27, 16886, 29, 17825]),
    ],
    dtype=float,
)


def risk_ratios():
    a, b, c, d = BCG.T
    values = np.log(a / (a + b)) - np.log(c / (c + d))
    return values, 1 / a - 1 / (a + b) + 1 / c - 1 / (c + d)


def test_the_spread_of_published_trials_is_that_of_metafor():
    """metafor's `rma(measure="RR", method="DL")` of the same table prints tau^2 = 0.3088."""
    assert between_run_variance(*risk_ratios()) == pytest.approx(0.3088, abs=5e-5)


def test_the_upper_limit_of_published_trials_is_that_of_metafor():
    """metafor's `confint` of the same prints 0.1197 to 1.1115 at 95 %."""
    assert largest_between_run_variance(*risk_ratios(), 0.975) == pytest.approx(1.1115, abs=5e-5)
    assert largest_between_run_variance(*risk_ratios(), 0.025) == pytest.approx(0.1197, abs=5e-5)


@pytest.mark.parametrize("runs", [2, 5, 20])
@pytest.mark.parametrize("spread", [0.0, 0.1, 1.0])
def test_the_true_spread_lies_below_its_upper_limit_nine_times_of_ten(rng, runs, spread):
    variances = rng.uniform(0.005, 0.02, runs)
    drawn = rng.normal(0, np.sqrt(variances + spread**2), (250, runs))
    limits = [largest_between_run_variance(values, variances) for values in drawn]
    assert np.mean(np.array(limits) >= spread**2) > 0.86


def test_runs_that_agree_have_no_spread():
    assert between_run_variance(np.array([1.0, 1.1, 0.9]), np.full(3, 0.5)) == 0.0


def test_the_mean_of_many_drawn_spreads_is_the_true_one(rng):
    variances = np.array([0.5, 1.0, 2.0, 4.0, 1.0, 1.0]) / 100
    drawn = rng.normal(0, np.sqrt(variances + 0.04), (4000, 6))
    found = [between_run_variance(values, variances) for values in drawn]
    assert np.mean(found) == pytest.approx(0.04, rel=0.03)


def test_without_a_spread_the_probability_is_that_of_the_normal_distribution():
    far = dissent(np.array([0.0, 0.0, 0.0, 0.3]), np.full(4, 0.01), 3)
    assert far.others == 0
    assert far.sigmas == pytest.approx(0.3 / np.sqrt(0.01 + 0.01 / 3))
    assert far.probability == pytest.approx(2 * norm.sf(far.sigmas))


@pytest.mark.parametrize("runs", [4, 10])
def test_runs_that_truly_spread_are_rarely_far_from_each_other(rng, runs):
    """Almost nothing but spread, estimated from few runs: at 1 % about 1 % are that far."""
    variances = np.full(runs, 1e-4)
    drawn = rng.normal(0, np.sqrt(1 + 1e-4), (3000, runs))
    far = np.mean([dissent(values, variances, 0).probability < 0.01 for values in drawn])
    assert 0.005 < far < 0.02
