import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from odometry.checks.statistics.relation import PIECES, pieces, relation


def test_against_the_normal_equations_without_outliers(rng):
    columns = rng.standard_normal((3, 200))
    target = np.array([2.0, -1.0, 0.5]) @ columns
    found = relation(target, *columns)
    assert found.coefficients == pytest.approx([2.0, -1.0, 0.5])
    assert found.correlation == pytest.approx(1.0)
    assert found.explained == pytest.approx(1.0)


@given(st.integers(0, 1000))
def test_a_fifth_of_outliers_does_not_move_the_slope(seed):
    rng = np.random.default_rng(seed)
    x = rng.uniform(-1, 1, 300)
    y = 1.7 * x + rng.normal(0, 0.02, 300)
    y[rng.choice(300, 60, replace=False)] += 5.0
    found = relation(y, x, np.ones(300))
    assert found.slope == pytest.approx(1.7, abs=6 * found.slope_sigma + 1e-3)
    assert found.kept.sum() <= 245
    assert found.explained < 0.5 < found.correlation


def test_too_little_is_no_relation():
    x = np.linspace(0, 1, 100)
    assert relation(x[:5], x[:5]) is None
    assert relation(x, x, 2 * x) is None
    assert relation(np.full(100, np.nan), x) is None


def test_pieces_are_quarters_of_what_was_measured(rng):
    """Half of the windows have no target, and each quarter of the others has a slope of its own."""
    x = rng.uniform(0.5, 1.0, 800)
    slopes = np.repeat(np.arange(1.0, PIECES + 1), 400 // PIECES)
    target = np.concatenate([np.full(400, np.nan), slopes]) * x
    found = [piece.slope for piece in pieces(target, x)]
    np.testing.assert_allclose(found, np.arange(1, PIECES + 1))
