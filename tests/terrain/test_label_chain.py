"""The chain of places against every sequence of terrains, counted one by one."""

from itertools import pairwise, product

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from terrain.label_chain import carried, likelihoods, smoothed
from terrain.label_rows import settled_by_rows

CHANGE_M = 4.0


def counted(likelihood, steps_m, prior):
    """Posterior of each place: every sequence, from where the prior holds, with its probability."""
    n, k = likelihood.shape
    total = np.zeros((n, k))
    for sequence in product(range(k), repeat=n + 1):
        probability = prior[sequence[0]]
        for (before, after), step_m in zip(pairwise(sequence), steps_m, strict=True):
            stay = np.exp(-step_m / CHANGE_M)
            probability *= stay * (before == after) + (1 - stay) / k
        for place, terrain in enumerate(sequence[1:]):
            probability *= likelihood[place, terrain]
        for place, terrain in enumerate(sequence[1:]):
            total[place, terrain] += probability
    return total / total.sum(axis=1, keepdims=True)


@settings(max_examples=25, deadline=None)
@given(st.integers(0, 2**32 - 1), st.integers(1, 5), st.integers(2, 4))
def test_smoothed_is_the_posterior(seed, n, k):
    rng = np.random.default_rng(seed)
    likelihood = rng.uniform(0.01, 1.0, (n, k))
    steps_m, prior = rng.uniform(0.0, 6.0, n), rng.dirichlet(np.ones(k))
    np.testing.assert_allclose(
        smoothed(likelihood, steps_m, prior, CHANGE_M),
        counted(likelihood, steps_m, prior),
        rtol=1e-9,
    )


def test_a_thousand_places_stay_finite():
    likelihood = np.full((1000, 3), 1e-3)
    likelihood[:, 1] = 1.0
    beliefs = smoothed(likelihood, np.full(1000, 0.1), np.ones(3) / 3, CHANGE_M)
    assert (beliefs[:, 1] > 0.99).all()


@given(st.floats(0.0, 1.0), st.floats(0.0, 1.0))
def test_two_ways_are_as_good_as_one(first, second):
    belief = np.array([0.7, 0.2, 0.1])
    twice = carried(carried(belief, np.array([first])), np.array([second]))
    np.testing.assert_allclose(twice, carried(belief, np.array([first * second])))
    assert twice.sum() == pytest.approx(1.0)


def test_a_label_speaks_for_its_terrain_as_far_as_labels_are_right():
    """Accuracy 0.8; wrong labels are spread over two names and the rest."""
    of_label, of_votes = likelihoods(
        ["mud", "mud"], [{}, {"mud": 0.5, "snow": 0.5}], ["mud", "snow"], 0.8
    )
    np.testing.assert_allclose(of_label, [0.8 + 0.2 / 3, 0.2 / 3, 0.2 / 3])
    np.testing.assert_allclose(of_votes, [0.4 + 0.2 / 3, 0.4 + 0.2 / 3, 0.2 / 3])


@pytest.mark.parametrize(
    ("labels", "needed", "settled"),
    [
        ("a a b b a a", 2, "a a b b a a"),
        ("a b a b a", 2, "a a a a a"),
        ("a b ? b b", 2, "a a ? b b"),
        ("b a b c c c", 3, "a a a c c c"),
        ("b c", 1, "b c"),
        ("b ? b ? b", 2, "a ? a ? a"),
        ("b b a c c", 2, "b b b c c"),
    ],
)
def test_rows(labels, needed, settled):
    """The terrain before is a; ? is unknown."""
    names = {"?": "unknown"}
    given_, wanted = ([names.get(n, n) for n in row.split()] for row in (labels, settled))
    assert settled_by_rows(given_, "a", needed) == wanted
