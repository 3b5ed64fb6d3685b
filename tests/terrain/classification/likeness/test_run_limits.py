"""How far the images of a run may look from the training photographs."""

import numpy as np
import pytest

from terrain.classification.likeness.run_limits import FALSE_ALARMS, NUMBERS, RunLimits

PATCHES = 4


def photographs(seed, photos=60):
    """Looks of two terrains, each photograph with shifts of its own."""
    rng = np.random.default_rng(seed)
    codes = np.repeat([0, 1], photos * PATCHES)
    groups = np.repeat(np.arange(2 * photos), PATCHES)
    looks = np.where(codes == 0, -3.0, 3.0)[:, None] + rng.normal(size=(len(codes), NUMBERS))
    displacements = rng.normal(0, 0.5, (2 * photos, NUMBERS))[groups]
    displacements = displacements + rng.normal(0, 0.2, displacements.shape)
    exposures = rng.uniform(-0.2, 0.2, 2 * photos)[groups]
    ranks = rng.uniform(0.3, 0.7, 2 * photos)[groups]
    light = exposures  # not used here
    return looks, np.column_stack([ranks, ranks, exposures, light, displacements]), codes, groups


@pytest.fixture(scope="module")
def limits():
    return RunLimits.of(*photographs(1))


def runs(seed, photos=3):
    looks, differences, _, groups = photographs(seed)
    for first in range(0, groups.max() + 2 - photos, photos):
        rows = (groups >= first) & (groups < first + photos)
        yield looks[rows], differences[rows]


def test_about_one_run_of_twenty_of_other_photographs_is_beyond():
    """With 150 training photographs a terrain; with fewer, limits are of these and too narrow."""
    fitted = [RunLimits.of(*photographs(seed, photos=150)) for seed in (50, 51, 52)]
    beyond = [of.beyond(*run) > 1 for of in fitted for seed in range(2, 12) for run in runs(seed)]
    assert FALSE_ALARMS / 2 < np.mean(beyond) < 2 * FALSE_ALARMS


@pytest.mark.parametrize(("number", "shift"), [(1, 0.5), (2, 0.5), (2, -0.5), (7, 2.0)])
def test_what_moves_all_images_in_one_direction_is_beyond(limits, number, shift):
    for looks, differences in runs(20):
        moved = differences.copy()
        moved[:, number] += shift
        assert limits.beyond(looks, moved) > 1


def test_nearer_to_the_photographs_than_these_to_each_other_is_not_beyond(limits):
    for looks, differences in runs(20):
        nearer = differences.copy()
        nearer[:, 1] = 0.0
        assert limits.apart(looks, nearer)[2] == 0.0


def test_a_run_over_both_terrains_may_be_less_exposed_apart(limits):
    """As many photographs average out what each has of its own."""
    looks, differences, codes, _ = photographs(30)
    one = codes == 0
    differences[:, 2] = 0.25
    assert limits.photographs(looks[one]) < 1.1
    assert limits.photographs(looks) > 10
    assert limits.apart(looks[one], differences[one])[1] == pytest.approx(0.25, rel=0.03)
    varied = limits.photographs(looks) ** 0.25
    assert limits.apart(looks, differences)[1] == pytest.approx(0.25 * varied)


def test_images_that_are_all_the_same_are_one_photograph(limits):
    assert limits.photographs(np.ones((9, NUMBERS))) == 1.0


def test_images_that_differ_more_than_photographs_are_one_photograph_each(limits):
    apart = 100.0 * np.arange(5)[:, None] * np.ones(NUMBERS)
    assert limits.photographs(apart) == pytest.approx(5)


def test_the_displacement_is_the_mahalanobis_distance_of_means_of_photographs():
    looks, differences, codes, groups = photographs(1)
    found = RunLimits.of(looks, differences, codes, groups)
    means = differences[:, 4:].reshape(-1, PATCHES, NUMBERS).mean(axis=1)  # as many of each
    np.testing.assert_allclose(found.middle, means.mean(axis=0))
    exact = np.sqrt(means[5] @ np.linalg.solve(np.cov(means.T, bias=True), means[5]))
    shifted = np.zeros((3, 4 + NUMBERS))
    shifted[:, 4:] = found.middle + means[5]
    assert found.apart(looks[:3], shifted)[0] == pytest.approx(exact, rel=0.01)


def test_about_one_photograph_of_twenty_is_beyond_by_any_number_of_patches():
    fitted = [RunLimits.of(*photographs(seed, photos=150)) for seed in (50, 51, 52)]
    for count in (1, PATCHES):
        beyond = [
            of.beyond_one(differences[:count]).max() > 1
            for of in fitted
            for seed in range(2, 6)
            for _, differences in runs(seed, photos=1)
        ]
        assert FALSE_ALARMS / 2 < np.mean(beyond) < 2 * FALSE_ALARMS


@pytest.mark.parametrize(("number", "shift"), [(1, 0.5), (2, 0.9), (7, 4.0)])
def test_a_photograph_is_beyond_where_it_differs_in_one_direction(limits, number, shift):
    for _, differences in runs(20, photos=1):
        moved = differences.copy()
        moved[:, number] += shift
        assert limits.beyond_one(moved).max() > 1


def test_a_file_keeps_them_and_an_older_one_has_none(limits):
    again = RunLimits.from_arrays(limits.arrays())
    for run in runs(40):
        assert again.beyond(*run) == limits.beyond(*run)
        np.testing.assert_array_equal(again.beyond_one(run[1]), limits.beyond_one(run[1]))
    before = {name: of for name, of in limits.arrays().items() if "photograph" not in name}
    assert RunLimits.from_arrays(before).beyond_one(run[1]) is None
    assert RunLimits.from_arrays({}) is None
    with pytest.raises(ValueError, match="shapes"):
        RunLimits.from_arrays(limits.arrays() | {"run_limits": np.ones(2)})
    with pytest.raises(ValueError, match="shapes"):
        RunLimits.from_arrays(limits.arrays() | {"run_photograph_limits": np.ones((5, 2))})
