import numpy as np
import pytest

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
    """Also where every row of the others is known."""
    one, others = rng.standard_normal(300), rng.standard_normal((300, 300))
    others[:, 200 : 200 + unknown] = np.nan
    others[0] = 2.0
    known = np.isfinite(others[1])
    with np.errstate(invalid="ignore"):
        expected = np.corrcoef(one[known], others[:, known])[0, 1:]
    np.testing.assert_allclose(_correlations(one, others), expected, atol=1e-12)
