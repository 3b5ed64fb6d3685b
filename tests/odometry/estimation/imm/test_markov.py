import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from odometry.errors import EstimationError
from odometry.estimation.imm.markov import ModeChain

dwells = st.lists(st.floats(0.05, 1e4), min_size=1, max_size=6)
microseconds = st.integers(0, 20_000_000)


@given(dwells, microseconds)
def test_rows_are_probabilities(dwell_s, step):
    matrix = ModeChain(np.array(dwell_s)).transition(step * 1e-6)
    assert matrix.shape == (len(dwell_s), len(dwell_s))
    assert np.all(matrix >= 0)
    np.testing.assert_allclose(matrix.sum(axis=1), 1, rtol=0, atol=1e-12)


@given(dwells, microseconds, microseconds)
def test_two_steps_are_one_long_step(dwell_s, one, other):
    chain = ModeChain(np.array(dwell_s))
    first, second, both = (chain.transition(n * 1e-6) for n in (one, other, one + other))
    np.testing.assert_allclose(first @ second, both, rtol=0, atol=1e-10)


@given(st.floats(0.1, 100), st.floats(0.1, 100), microseconds)
def test_two_modes_have_a_closed_form(dwell_0, dwell_1, step):
    """exp(-(a + b) t) is how much of the start is left; a from 0 to 1, b back."""
    a, b, step_s = 1 / dwell_0, 1 / dwell_1, step * 1e-6
    left = np.exp(-(a + b) * step_s)
    expected = np.array([[b + a * left, a - a * left], [b - b * left, a + b * left]]) / (a + b)
    matrix = ModeChain(np.array([dwell_0, dwell_1])).transition(step_s)
    np.testing.assert_allclose(matrix, expected, rtol=0, atol=1e-12)


def test_row_is_from_and_column_is_to():
    """Mode 0 leaves soon, and only to mode 2; mode 2 is never left."""
    shares = np.array([[0, 0, 1.0], [0.5, 0, 0.5], [1, 0, 0]])
    chain = ModeChain(np.array([0.1, 100.0, np.inf]), shares)
    matrix = chain.transition(0.2)
    assert matrix[0, 2] == pytest.approx(1 - np.exp(-2), abs=1e-12)
    assert matrix[0, 1] == 0
    np.testing.assert_array_equal(matrix[2], [0, 0, 1])
    assert matrix[1, 2] > 0.001


def test_mean_dwell_time_is_as_given(rng):
    """Time in mode 1 before it is left, over a walk by the matrices of 10 ms: 2 s on average."""
    matrix = ModeChain(np.array([5.0, 2.0, 1.0])).transition(0.01)
    stays = rng.geometric(1 - matrix[1, 1], size=20_000) * 0.01
    assert stays.mean() == pytest.approx(2.0, rel=0.03)


def test_long_run_shares_of_time_are_those_of_the_dwells():
    """With departures shared evenly the stationary law is in proportion to the dwell times."""
    dwell_s = np.array([4.0, 1.0, 3.0])
    matrix = ModeChain(dwell_s).transition(1000.0)
    np.testing.assert_allclose(matrix, np.tile(dwell_s / 8, (3, 1)), atol=1e-12)


def test_one_mode_alone_stays():
    np.testing.assert_array_equal(ModeChain(np.array([3.0])).transition(7.0), [[1.0]])
    alone = ModeChain(np.array([3.0]), np.zeros((1, 1)))
    np.testing.assert_array_equal(alone.transition(7.0), [[1.0]])


@pytest.mark.parametrize("modes", [1, 2, 5])
def test_rates_are_a_generator(modes):
    rates = ModeChain(np.arange(1.0, modes + 1)).rates
    np.testing.assert_allclose(rates.sum(axis=1), 0, atol=1e-15)
    leaving = 1 / np.arange(1.0, modes + 1) if modes > 1 else [0.0]
    np.testing.assert_allclose(-np.diag(rates), leaving)


def test_no_time_changes_nothing():
    np.testing.assert_array_equal(ModeChain(np.ones(4)).transition(0.0), np.eye(4))


def test_uneven_stamps_share_a_matrix_that_nobody_can_change():
    chain = ModeChain(np.ones(3))
    matrix = chain.transition(0.05)
    assert chain.transition(0.05 + 3e-8) is matrix
    with pytest.raises(ValueError, match="read-only"):
        matrix[0, 0] = 0


@pytest.mark.parametrize(
    ("dwell_s", "shares", "message"),
    [
        ([1.0, -2.0], None, "mode 1: dwell time -2.0 s, expected above 0"),
        ([0.0], None, "mode 0: dwell time 0.0 s"),
        ([np.nan, 1.0], None, "mode 0: dwell time nan s"),
        ([], None, "shape"),
        ([[1.0]], None, "shape"),
        ([1.0, 1.0], np.eye(3), "expected .2, 2"),
        ([1.0, 1.0], [[0, 1], [0.5, 0]], "mode 1: shares .0.5, 0.0., .* sum 1"),
        ([1.0, 1.0], [[0.5, 0.5], [1, 0]], "mode 0: share 0.5 of itself"),
        ([1.0, 1.0, 1.0], [[0, 2, -1], [1, 0, 0], [1, 0, 0]], "mode 0: shares"),
    ],
)
def test_what_is_no_chain_is_refused(dwell_s, shares, message):
    with pytest.raises(EstimationError, match=message):
        ModeChain(np.array(dwell_s), None if shares is None else np.array(shares))


@pytest.mark.parametrize("step_s", [-0.1, np.nan, np.inf])
def test_a_step_back_in_time_is_refused(step_s):
    with pytest.raises(EstimationError, match="step of"):
        ModeChain(np.ones(2)).transition(step_s)
