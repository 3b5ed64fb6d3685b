import numpy as np
import pytest

from odometry.checks.evidence.evidence import Evidence
from odometry.checks.evidence.once import once
from odometry.checks.statistics.least_squares import Columns, least_squares, of_products
from odometry.checks.unexplained import disagreement
from tests.odometry.checks.drives import winding


@pytest.mark.parametrize("count", [1, 2, 3])
def test_products_give_what_a_decomposition_gives(rng, count):
    scales = 10.0 ** np.arange(count)[:, None]
    columns = scales * (1 + 0.3 * rng.standard_normal((count, 60)))
    target = rng.standard_normal(60)
    expected = np.linalg.lstsq(columns.T, target, rcond=None)[0]
    np.testing.assert_allclose(least_squares(columns, target), expected, rtol=1e-10)
    both = np.vstack([columns, target])
    np.testing.assert_allclose(of_products(both @ both.T), expected, rtol=1e-10)
    inverse = np.linalg.pinv(columns @ columns.T)
    np.testing.assert_allclose(Columns(columns).variances(), np.diag(inverse), rtol=1e-8)
    assert Columns(columns).independent


@pytest.mark.parametrize("off", [0.0, 1e-9, 1e-5])
@pytest.mark.parametrize("more", [0, 1])
def test_columns_that_nearly_follow_from_others_are_decomposed(rng, off, more):
    first, *others, noise = rng.standard_normal((2 + more, 60))
    columns = np.array([first, *others, 2 * first + off * noise])
    target = rng.standard_normal(60)
    expected = np.linalg.lstsq(columns.T, target, rcond=None)[0]
    np.testing.assert_array_equal(least_squares(columns, target), expected)
    both = np.vstack([columns, target])
    assert of_products(both @ both.T) is None
    assert Columns(columns).independent == (off > 0)


@pytest.mark.parametrize("size", [1e-160, 1e-87, 1e160])
def test_squares_that_vanish_or_overflow_are_not_used(rng, size):
    columns = size * rng.standard_normal((2, 60))
    with np.errstate(over="ignore"):
        found = least_squares(columns, 3 * columns[0])
    np.testing.assert_allclose(found, [3.0, 0.0], atol=1e-12)


def test_a_column_that_is_nothing_beside_another_counts_as_none(rng):
    columns = np.array([[1.0], [1e-17]]) * rng.standard_normal((2, 60))
    assert not Columns(columns).independent


def test_an_answer_is_looked_for_once_and_belongs_to_its_evidence():
    asked = []
    ask = once(lambda evidence: asked.append(evidence) or len(asked))
    first, second = Evidence(winding(100)), Evidence(winding(100))
    assert [ask(first), ask(second), ask(first), ask(second)] == [1, 2, 1, 2]
    assert disagreement.lasting_disagreements(first) is disagreement.lasting_disagreements(first)
