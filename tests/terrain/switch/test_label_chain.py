"""The chain of places against every sequence of terrains and looks, counted one by one."""

from itertools import pairwise, product

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from terrain.switch.label_chain import (
    REFUSED,
    REFUSED_UNNAMED,
    UNNAMED,
    carried,
    given_to,
    smoothed,
)
from terrain.switch.place_beliefs import terrains_by_rows

CHANGE_M = 4.0


ALIKE_M = 0.7
ACCURACY = 0.8
SETTINGS = {"accuracy": ACCURACY, "change_m": CHANGE_M, "alike_m": ALIKE_M}
SURER = {"accuracy": 0.9, "alike_m": 0.2}


def drawn_probability(terrain, names):
    """Of a new terrain: the names, then two kinds without one."""
    return (1 - UNNAMED) / names if terrain < names else UNNAMED / 2


def look_probability(look, terrain, names):
    """A look of a terrain: like one of the names, or, of number `names`, like none."""
    wrong = (1 - ACCURACY) / 2
    like_none = REFUSED_UNNAMED[terrain - names] if terrain >= names else REFUSED
    if look == names:
        return like_none
    if terrain >= names:
        return (1 - like_none) / names
    return (1 - like_none) * ((1 - wrong) * (look == terrain) + wrong / names)


def label_probability(label, look, names):
    """A label, or none where all are zero, of a look."""
    wrong = (1 - ACCURACY) / 2
    if not label.any():
        return 1 - REFUSED if look == names else REFUSED
    if look == names:
        return REFUSED / names
    return (1 - REFUSED) * ((1 - wrong) * label[look] + wrong / names)


def step_probability(before, after, step_m, names):
    """From a terrain and look to the next."""
    (old, old_look), (new, look) = before, after
    stay, alike = np.exp(-step_m / CHANGE_M), np.exp(-step_m / ALIKE_M)
    fresh = look_probability(look, new, names)
    same = alike * (look == old_look) + (1 - alike) * fresh
    return stay * (new == old) * same + (1 - stay) * drawn_probability(new, names) * fresh


def counted(given_, steps_m, prior):
    """Posterior of each place: every sequence of terrains and looks, with its probability."""
    n, names = given_.shape
    total = np.zeros((n, names + 2))
    first = np.append(prior[:names], [prior[names] / 2] * 2)
    states = list(product(range(names + 2), range(names + 1)))
    for sequence in product(states, repeat=n + 1):
        terrain, look = sequence[0]
        probability = first[terrain] * look_probability(look, terrain, names)
        for (before, after), step_m in zip(pairwise(sequence), steps_m, strict=True):
            probability *= step_probability(before, after, step_m, names)
        for label, (_, look) in zip(given_, sequence[1:], strict=True):
            probability *= label_probability(label, look, names)
        for place, (terrain, _) in enumerate(sequence[1:]):
            total[place, terrain] += probability
    total = np.column_stack([total[:, :names], total[:, names:].sum(axis=1)])
    return total / total.sum(axis=1, keepdims=True)


@settings(max_examples=10, deadline=None)
@given(st.integers(0, 2**32 - 1), st.sampled_from([(1, 3), (2, 2), (3, 1)]))
def test_smoothed_is_the_posterior(seed, shape):
    rng = np.random.default_rng(seed)
    n, names = shape
    given_ = rng.dirichlet(np.ones(names), n) * rng.integers(0, 2, (n, 1))
    steps_m, prior = rng.uniform(0.0, 2.0, n), rng.dirichlet(np.ones(names + 1))
    np.testing.assert_allclose(
        smoothed(given_, steps_m, prior, **SETTINGS),
        counted(given_, steps_m, prior),
        rtol=1e-9,
    )


def test_a_belief_that_is_carried_goes_to_its_mean():
    """Rows of several beliefs each: those of four terrains, on which the next place stays."""
    beliefs = np.array([[0.7, 0.2, 0.1, 0.0], [0.1, 0.1, 0.1, 0.7], [1.0, 0.0, 0.0, 0.0]])
    stay = np.array([[1.0], [0.6], [0.0]])
    expected = [[0.7, 0.2, 0.1, 0.0], [0.16, 0.16, 0.16, 0.52], [0.25] * 4]
    assert carried(beliefs, stay) == pytest.approx(np.array(expected))


def test_a_thousand_places_stay_finite():
    given_ = np.tile([0.0, 1.0], (1000, 1))
    beliefs = smoothed(given_, np.full(1000, 0.1), np.ones(3) / 3, **SETTINGS)
    assert (beliefs[:, 1] > 0.9).all()


def test_a_stretch_says_the_same_in_few_labels_and_in_many():
    """The nearest of 0.4 m of places with a label every 0.1 m and every 0.01 m, and of 1.2 m."""

    def believed(length_m, spacing_m):
        count = round(length_m / spacing_m)
        steps_m = np.append(1.0, np.full(count, spacing_m))
        given_ = np.tile([0.0, 1.0], (count + 1, 1))
        return smoothed(given_, steps_m, np.array([1.0, 0.0, 0.0]), **(SETTINGS | SURER))[0, 1]

    assert believed(0.4, 0.01) == pytest.approx(believed(0.4, 0.1), abs=0.02)
    assert 1 - believed(1.2, 0.1) < (1 - believed(0.4, 0.01)) / 2


def test_labels_that_contradict_each_other_speak_for_no_name():
    given_ = np.eye(3)[np.random.default_rng(2).integers(0, 3, 40)]
    beliefs = smoothed(given_, np.full(40, 0.25), np.array([1.0, 0, 0, 0]), **(SETTINGS | SURER))
    assert (beliefs[8:-8, -1] > 0.9).all()


@pytest.mark.parametrize(("named", "is_known"), [(0.9, True), (0.25, False)])
def test_names_among_many_images_without_one_speak_for_no_name(named, is_known):
    rng = np.random.default_rng(4)
    given_ = np.eye(6)[rng.integers(0, 2, 80)] * (rng.random((80, 1)) < named)
    given_[given_.any(axis=1)] = np.eye(6)[0] if is_known else given_[given_.any(axis=1)]
    beliefs = smoothed(given_, np.full(80, 0.25), np.eye(7)[0], **(SETTINGS | SURER))
    assert (beliefs[8:-8, 0 if is_known else -1] > 2 / 3).mean() > 0.95


@given(st.floats(0.0, 1.0), st.floats(0.0, 1.0))
def test_two_ways_are_as_good_as_one(first, second):
    belief = np.array([0.7, 0.2, 0.1])
    twice = carried(carried(belief, np.array([first])), np.array([second]))
    np.testing.assert_allclose(twice, carried(belief, np.array([first * second])))
    assert twice.sum() == pytest.approx(1.0)


def test_a_label_without_probabilities_is_sure():
    votes = {"mud": 0.5, "snow": 0.3, "sand": 0.2}
    labels, of = ["mud", "mud", "unknown"], [{}, votes, votes]
    of_label, of_votes, of_none = given_to(labels, of, ["mud", "snow"])
    np.testing.assert_array_equal(of_label, [1.0, 0.0])
    np.testing.assert_array_equal(of_votes, [0.5, 0.3])
    np.testing.assert_array_equal(of_none, [0.0, 0.0])


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
    assert terrains_by_rows(given_, "a", needed) == wanted
