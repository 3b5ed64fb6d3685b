import numpy as np
import pytest
from numpy.lib.stride_tricks import sliding_window_view

from odometry.checks.statistics.lag import _correlations, lag_between


@pytest.fixture(scope="module")
def heading():
    """A smooth random heading as a function of time."""
    rng = np.random.default_rng(3)
    stamps_s = np.arange(0, 140, 0.01)
    rate = np.convolve(rng.standard_normal(len(stamps_s)), np.hanning(120), mode="same")
    summed = np.cumsum(rate) * 0.01
    return lambda at_s: np.interp(at_s, stamps_s, summed, left=np.nan, right=np.nan)


@pytest.mark.parametrize("delay_s", [-0.7, -0.13, 0.0, 0.04, 0.33, 1.2])
def test_a_delay_is_found(heading, delay_s):
    found = lag_between(lambda t: heading(t - delay_s), heading, (5.0, 130.0), 0.5, 2.0)
    assert found.seconds == pytest.approx(delay_s, abs=0.005)
    assert abs(found.drift) < 1e-4


def test_a_clock_that_is_fast_shows_as_drift(heading):
    found = lag_between(lambda t: heading(t / 1.005), heading, (5.0, 130.0), 0.5, 2.0)
    assert found.drift == pytest.approx(0.005, abs=5 * found.drift_sigma)
    assert found.drift > 10 * found.drift_sigma


def test_signals_of_different_motion_have_no_lag(heading):
    assert lag_between(lambda t: heading(t + 61.0), heading, (5.0, 70.0), 0.5, 2.0) is None


def test_periodic_motion_has_no_lag():
    assert (
        lag_between(lambda t: np.sin(5 * t - 1), lambda t: np.sin(5 * t), (0, 60), 0.5, 2) is None
    )


@pytest.mark.parametrize("unknown", [0, 40])
def test_correlations_are_of_what_both_know(rng, unknown):
    """Also where all of it is known, and where one of them does not move."""
    one, other = 3 + rng.standard_normal(300), 2 + rng.standard_normal(1000)
    other[600:640], one[70 : 70 + unknown] = np.nan, np.nan
    other[:310] = 2.1
    others = sliding_window_view(other, len(one))
    expected = [
        np.corrcoef(one[known], row[known])[0, 1] if np.ptp(row[known]) > 0 else np.nan
        for row, known in zip(others, np.isfinite(others) & np.isfinite(one), strict=True)
    ]
    np.testing.assert_allclose(_correlations(one, other), expected, atol=1e-12)
    assert np.isnan(expected[:11]).all()


def test_correlations_of_too_little_are_unknown(rng):
    one, other = rng.standard_normal((2, 200))
    other[79:] = np.nan  # half of the least piece is 80 values
    assert np.isnan(_correlations(one, other)).all()
    other[79] = 1.0
    assert np.isfinite(_correlations(one, other)).all()


def test_a_signal_that_stands_far_from_its_mean_has_no_correlation(rng):
    one, other = rng.standard_normal((2, 600))
    other[:300] += 1000 + np.pi
    other[:250] = 1000 + np.pi
    assert np.isnan(_correlations(one[:200], other)[:51]).all()
