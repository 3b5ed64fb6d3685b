import numpy as np
import pytest

from terrain.classification.neighbours.validation import (
    Samples,
    best_way,
    cross_validate,
    grouped_folds,
)
from terrain.classification.presets import PlainNeighbours
from terrain.errors import PatchError


def ground(rng, photos=6, patches=5, photo_spread=0.3):
    """Two classes; patches of one photograph are nearly the same."""
    codes = np.repeat([0, 1], photos * patches)
    groups = np.repeat(np.arange(2 * photos), patches)
    centres = rng.normal(0, photo_spread, (2 * photos, 2))
    features = codes[:, None] + centres[groups] + rng.normal(0, 1e-3, (len(codes), 2))
    return features, codes, groups


def test_folds_keep_photographs_whole_and_judge_each_patch_once(rng):
    _, codes, groups = ground(rng)
    folds = grouped_folds(codes, groups)
    assert len(folds) == 5
    for train, test in folds:
        assert not set(groups[train]) & set(groups[test])
        assert set(codes[train]) == {0, 1}
    judged = np.concatenate([test for _, test in folds])
    np.testing.assert_array_equal(np.sort(judged), np.arange(len(codes)))


def test_few_photographs_give_few_folds():
    codes, groups = np.repeat([0, 1], 6), np.repeat([0, 1, 2, 3, 4], [3, 3, 2, 2, 2])
    assert len(grouped_folds(codes, groups)) == 2


def test_classes_in_the_same_lopsided_photographs_cannot_be_split():
    patches = {  # (class, photograph): patches; each half holds all of some class
        (0, 0): 138, (0, 2): 1, (1, 1): 54, (1, 4): 100, (2, 0): 144,
        (2, 3): 4, (3, 0): 18, (3, 1): 20, (4, 2): 49, (4, 3): 12,
    }  # fmt: skip
    codes, groups = (np.repeat([key[i] for key in patches], list(patches.values())) for i in (0, 1))
    with pytest.raises(PatchError, match="no split"):
        grouped_folds(codes, groups)


def test_photographs_do_not_vouch_for_themselves(rng):
    """Labels by photograph at random: leaking folds would recognise each photograph."""
    features, _, groups = ground(rng, photos=40, photo_spread=1.0)
    codes = rng.permutation(np.repeat([0, 1], 40))[groups]
    found = cross_validate(PlainNeighbours, (1, 3), Samples(features, codes, groups))
    assert np.mean(found.probabilities.argmax(axis=1) == found.codes) < 0.75


def test_k_is_the_best_and_the_largest_of_equals(rng):
    features, codes, groups = ground(rng, photo_spread=0.05)
    found = cross_validate(PlainNeighbours, (1, 3, 5, 100), Samples(features, codes, groups))
    assert found.n_neighbors == 5
    codes_of_photos = np.repeat([0, 1], 30)
    noisy = rng.normal(codes_of_photos[:, None], 1.2, (60, 1))
    chosen = cross_validate(
        PlainNeighbours, (1, 15), Samples(noisy, codes_of_photos, np.arange(60))
    )
    assert chosen.n_neighbors == 15


def test_answers_line_up_with_their_patches(rng):
    features, codes, groups = ground(rng, photo_spread=0.05)
    order = rng.permutation(len(codes))
    found = cross_validate(
        PlainNeighbours, (1, 3), Samples(features[order], codes[order], groups[order])
    )
    np.testing.assert_array_equal(found.codes, codes[order][found.rows])
    np.testing.assert_array_equal(found.probabilities.argmax(axis=1), found.codes)
    np.testing.assert_allclose(found.probabilities.sum(axis=1), 1)
    assert (found.distances > 1e-3).all()


def test_k_is_small_where_classes_interlace():
    """Islands of four photographs: their neighbours beyond are of the other class."""
    islands = np.repeat(np.arange(30), 4)
    features = islands[:, None] + np.tile([0.0, 0.01, 0.02, 0.03], 30)[:, None]
    found = cross_validate(PlainNeighbours, (1, 15), Samples(features, islands % 2, np.arange(120)))
    assert found.n_neighbors == 1
    np.testing.assert_array_equal(found.probabilities.argmax(axis=1), found.codes)


def test_patches_of_a_fold_that_cannot_train_are_left_out():
    patches = {  # (class, photograph): patches; one half holds all of class 1
        (0, 0): 10, (0, 1): 14, (0, 2): 59, (0, 3): 20, (1, 0): 2, (1, 1): 15,
        (2, 0): 1, (2, 1): 35, (2, 2): 46, (3, 0): 31, (3, 1): 16,
    }  # fmt: skip
    codes, groups = (np.repeat([key[i] for key in patches], list(patches.values())) for i in (0, 1))
    ((_, judged),) = grouped_folds(codes, groups)
    features = codes[:, None] + np.linspace(0, 0.1, len(codes))[:, None]
    found = cross_validate(PlainNeighbours, (1,), Samples(features, codes, groups))
    np.testing.assert_array_equal(found.rows, np.sort(judged))
    np.testing.assert_array_equal(found.codes, codes[found.rows])
    assert np.isfinite(found.probabilities).all()
    assert len(found.distances) == len(judged) < len(codes)


def test_the_better_way_is_chosen_and_of_equals_the_first(rng):
    samples = Samples(*ground(rng))

    class Blind(PlainNeighbours):
        def fit(self, features, codes, copies=0, shares=None):
            return super().fit(np.zeros_like(features), codes, copies, shares)

    way, found, _ = best_way((Blind, PlainNeighbours), (1, 3), samples)
    assert way is PlainNeighbours
    again = cross_validate(PlainNeighbours, (1, 3), samples)
    np.testing.assert_array_equal(found.probabilities, again.probabilities)
    first, second = (type("Same", (PlainNeighbours,), {}) for _ in range(2))
    assert best_way((first, second), (1,), samples)[0] is first


def test_each_class_and_each_photograph_of_a_class_counts_the_same():
    codes, groups = np.array([0, 0, 0, 1, 1, 1, 1]), np.array(["a", "a", "b", "c", "c", "c", "a"])
    copies = Samples(np.zeros((2, 1)), np.array([0, 0]), np.array(["b", "z"]))
    samples = Samples(np.zeros((7, 1)), codes, groups)
    *_, shares = samples.with_copies(np.arange(7), copies)
    expected = [1 / 8, 1 / 8, 1 / 8, 1 / 12, 1 / 12, 1 / 12, 1 / 4, 1 / 8]
    np.testing.assert_allclose(shares, expected, atol=1e-12)
    *_, alone = samples.with_copies(np.array([0, 2, 3]), None)
    np.testing.assert_allclose(alone, [1 / 4, 1 / 4, 1 / 2], atol=1e-12)
