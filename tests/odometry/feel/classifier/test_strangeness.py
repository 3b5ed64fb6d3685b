"""How strange a window is: weights against an independent fit, and what they may not do."""

import numpy as np
import pytest
from sklearn.linear_model import LogisticRegression

from odometry.feel.classifier.strangeness import (
    MOST_NAMED,
    RIDGE,
    SHARES,
    SURE,
    TERMS,
    Strangeness,
    Unseen,
    farness,
    fitted_weights,
    modest_share,
    terms,
    unknown_probability,
)


def simulated(seed, shift, count=600):
    """Windows of which half are unseen: `shift` says by how much each term is larger then."""
    rng = np.random.default_rng(seed)
    is_unseen = np.arange(count) % 2 == 0
    table = rng.normal(size=(count, TERMS)) + np.outer(is_unseen, np.append(0.0, shift))
    table[:, 0] = 1.0
    return Unseen(table, is_unseen, np.full(count, 1 / count), np.full(count, 0.95))


def test_the_weights_are_those_of_a_logistic_regression():
    part = simulated(1, [0.7])
    columns = part.table[:, 1:]
    standard = (columns - columns.mean(axis=0)) / columns.std(axis=0)
    other = LogisticRegression(C=1 / (RIDGE * len(columns)), tol=1e-10, max_iter=1000)
    other.fit(standard, part.is_unseen)
    odds = part.table @ fitted_weights([part])
    np.testing.assert_allclose(odds, other.decision_function(standard), atol=1e-4)


def test_nothing_makes_a_window_less_strange():
    assert fitted_weights([simulated(2, [-1.0])])[1] == 0


def test_a_distance_that_does_not_vary_has_no_weight():
    part = simulated(3, [0.0])
    part.table[:, 1] = -13.8
    assert fitted_weights([part])[1] == 0


def test_what_windows_have_in_common_stays_and_what_differs_averages_out():
    rng = np.random.default_rng(6)
    centres = np.array([[0.0, 0.0], [5.0, 0.0]])
    for shift in (0.0, 2.0):
        windows = np.array([0.0, shift]) + rng.normal(size=(4000, 2))
        single = farness(windows[:, None] - centres).mean()
        together = farness((windows[:, None] - centres).mean(axis=0)[None])[0]
        assert together == pytest.approx(shift**2, abs=0.1)
        assert single == pytest.approx(shift**2 + 2, rel=0.1)
    assert farness(np.array([[[np.inf], [0.5]]]))[0] == 0.25
    table = terms(np.array([1.0, 4.0]))
    np.testing.assert_allclose(table, [[1.0, 0.0], [1.0, np.log(4.0)]], atol=1e-9)


@pytest.mark.parametrize("share", [0.1, 0.3])
def test_without_evidence_unknown_is_as_probable_as_before(share):
    assert unknown_probability(np.zeros(1), share)[0] == pytest.approx(share)
    assert unknown_probability(np.array([np.log(9.0)]), 0.1)[0] == pytest.approx(0.5)
    found = unknown_probability(np.array([-800.0, 800.0]), share)
    np.testing.assert_allclose(found, [0.0, 1.0], atol=1e-300)


def test_what_was_left_out_is_rarely_named():
    """Without a distance that helps, the share is the greatest that leaves sure names possible."""
    easy, fair, blind = simulated(4, [6.0]), simulated(5, [2.5]), simulated(6, [0.0])

    def found(*parts):
        weights = fitted_weights(parts)
        share = modest_share({"run": parts}, {"run": weights})
        unknown = [unknown_probability(of.table @ weights, share) for of in parts]
        named = [
            (of.sure * (1 - one) >= SURE)[of.is_unseen].mean()
            for of, one in zip(parts, unknown, strict=True)
        ]
        return share, np.mean(named)

    assert found(easy)[0] == SHARES[0]
    share, named = found(easy, fair, fair)
    assert SHARES[0] < share < SHARES[-1]
    assert named <= MOST_NAMED
    assert found(blind)[0] == SHARES[-1]
    assert 1 - SHARES[-1] > SURE


def test_what_cannot_be_distinguished_has_no_weights():
    assert not any(of.any() for of in Strangeness.none().weights.values())
