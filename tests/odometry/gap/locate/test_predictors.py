"""Tests of variables: false discoveries on residuals that nothing predicts, and true ones."""

from dataclasses import replace

import numpy as np
import pytest
from scipy.stats import kruskal, rankdata

from odometry.gap.locate.predictors import _ranks, groups_of, predictors
from odometry.gap.locate.variables import Variable, window_variables
from odometry.gap.prepare.end_residuals import Ends, ends_of

WINDOWS, PIECE = 80, 5


def ends(motion, leeway=None):
    count = len(motion)
    leeway = np.zeros((count, 3, 0)) if leeway is None else leeway
    return Ends(motion, np.ones((count, 3)), leeway, np.arange(count) // PIECE)


def slow(rng, count=WINDOWS):
    """What changes little from window to window, and not at all between pieces at random."""
    return np.repeat(rng.normal(size=count // PIECE), PIECE) + 0.1 * rng.normal(size=count)


def made(rng):
    """Ten variables of all kinds."""
    scalars = [Variable(f"s{i}", "", "scalar", slow(rng)) for i in range(6)]
    angles = [Variable(f"a{i}", "rad", "angle", rng.uniform(-3, 3, WINDOWS)) for i in range(2)]
    names = np.repeat(rng.choice(["mud", "ice"], WINDOWS // PIECE), PIECE)
    labels = [Variable("l", "", "label", names)] if len(set(names)) > 1 else []
    return [*scalars, *angles, *labels]


@pytest.mark.slow
def test_residuals_alike_within_pieces_are_not_discoveries():
    """Errors of a piece share a part: the usual distribution of the statistic is far off."""
    wrong, usual = 0, 0
    for seed in range(30):
        rng = np.random.default_rng(seed)
        variables = made(rng)
        shared = np.repeat(rng.normal(size=(WINDOWS // PIECE, 3)), PIECE, axis=0)
        motion = shared + rng.normal(size=(WINDOWS, 3))
        wrong += any(one.discovered for one in predictors(variables, ends(motion)))
        groups = groups_of(variables[0])
        usual += kruskal(*(motion[groups == g, 0] for g in set(groups))).pvalue < 0.05
    assert usual >= 6
    assert wrong <= 4  # of 30 at 5 %: more than 4 in 1.6 % of trials


@pytest.mark.slow
def test_effect_free_runs_seldom_show_a_discovery(make_scene, known):
    """Windows of simulated runs share poses, and fast ones have more noise."""
    shown = 0
    for seed in range(30):
        scenes = (make_scene(seed),)
        found = ends_of(known.base, (), scenes, known, 10.0)
        variables = window_variables(known.base, (), scenes)
        shown += any(one.discovered for one in predictors(variables, found))
    assert shown <= 4


def test_what_the_calibration_leaves_open_is_not_a_discovery(rng):
    speed = rng.uniform(-1, 1, WINDOWS)
    leeway = np.zeros((WINDOWS, 3, 1))
    leeway[:, 0, 0] = 2 * speed
    motion = rng.normal(size=(WINDOWS, 3)) + leeway[..., 0]
    variables = [Variable("speed", "m/s", "scalar", speed)]
    assert predictors(variables, ends(motion))[0].discovered
    assert not predictors(variables, ends(motion, leeway))[0].discovered


@pytest.mark.parametrize("kind", ["scalar", "angle", "label"])
@pytest.mark.parametrize("predicts", ["size", "along", "across", "turn"])
def test_a_dependence_is_found_and_named(rng, kind, predicts):
    variables = made(rng)
    values = rng.uniform(-np.pi, np.pi, WINDOWS)
    signal = np.sign(np.abs(values) - 1.5)  # no trend in the variable
    if kind == "label":
        values = np.where(signal > 0, "mud", "ice")
    motion = rng.normal(size=(WINDOWS, 3))
    if predicts == "size":
        motion[:, :2] *= np.where(signal > 0, 6.0, 1.0)[:, None]
    else:
        motion[:, ("along", "across", "turn").index(predicts)] += 1.5 * signal
    found = predictors([*variables, Variable("it", "u", kind, values)], ends(motion))
    assert (found[0].name, found[0].unit) == ("it", "u")
    assert found[0].discovered
    assert found[0].predicts == predicts
    assert 0.2 < found[0].strength <= 1
    assert found[0].p_value <= 0.001
    assert all(not one.discovered or one is found[0] for one in found)


def test_the_statistic_is_that_of_kruskal_and_wallis(rng):
    """By the strength, which is a function of the statistic alone."""
    variable = Variable("x", "", "scalar", rng.normal(size=WINDOWS))
    motion = rng.normal(size=(WINDOWS, 3)) + variable.values[:, None] * [0.0, 0.0, 3.0]
    groups = groups_of(variable)
    expected = kruskal(*(motion[groups == g, 2] for g in range(5))).statistic
    found = predictors([variable], ends(motion))[0]
    assert found.predicts == "turn"
    assert found.strength == pytest.approx((expected - 5 + 1) / (WINDOWS - 5))


@pytest.mark.parametrize("equal", [False, True])
def test_ranks_are_those_of_scipy_with_and_without_equal_ones(rng, equal):
    normalised = rng.normal(size=(7, WINDOWS, 3))
    if equal:
        normalised[2, 5] = normalised[2, 60]
    size = np.hypot(normalised[..., :1], normalised[..., 1:2])
    expected = rankdata(np.concatenate([size, normalised], axis=-1), axis=1)
    np.testing.assert_array_equal(_ranks(normalised), expected)
    assert (expected % 1 == 0.5).any() == equal


def test_groups_are_quantiles_sectors_and_labels():
    values = np.arange(10.0)
    assert groups_of(Variable("x", "", "scalar", values)).tolist() == [0, 0, 1, 1, 2, 2, 3, 3, 4, 4]
    angles = np.radians([-179.0, -121.0, -119.0, 0.5, 61.0, 180.0])
    assert groups_of(Variable("x", "", "angle", angles)).tolist() == [0, 0, 1, 3, 4, 5]
    labels = np.array(["b", "a", "b"])
    assert groups_of(Variable("x", "", "label", labels)).tolist() == [1, 0, 1]


def test_the_same_twice(rng):
    motion, variables = rng.normal(size=(WINDOWS, 3)), made(rng)
    assert predictors(variables, ends(motion)) == predictors(variables, ends(motion))
    assert predictors([], ends(motion)) == ()


def test_noise_and_calibration_are_taken_off_the_excess(make_scene, known):
    """Zero on average on every kind of window: slow and fast, straight and turning."""
    scenes = tuple(make_scene(seed) for seed in range(20))
    found = ends_of(known.base, (), scenes, known, 10.0)
    speed = np.abs(
        next(v for v in window_variables(known.base, (), scenes) if v.name == "speed").values
    )
    for chosen in (speed < 0.2, speed > 0.5):
        mean, error = found.excess_m2[chosen].mean(), found.deviation_m2[chosen].mean()
        assert chosen.sum() > 100
        assert abs(mean) < 4 * error / np.sqrt(chosen.sum())
        assert found.excess_m2[chosen].std() == pytest.approx(error, rel=0.25)


def test_leeway_is_the_spread_of_what_the_base_may_do(make_scene, known, rng):
    """Against residuals of bases drawn from the covariance."""
    scenes = (make_scene(5, duration_s=60.0),)
    sigma = np.array([0.004, 0.003, 0.002, 0.001, 0.002])
    mixed = rng.normal(size=(5, 5))
    covariance = 0.05 * (mixed @ mixed.T) * np.outer(sigma, sigma)
    unsure = replace(known.uncertain, free=np.ones(5, dtype=bool))
    free = replace(known, uncertain=unsure, information=np.linalg.inv(covariance))
    found = ends_of(known.base, (), scenes, free, 10.0)
    drawn = []
    for values in rng.multivariate_normal(known.base.values, covariance, 400):
        base = replace(known.base, values=values)
        drawn.append(ends_of(base, (), scenes, known, 10.0).motion - found.motion)
    spread = np.sqrt((found.leeway**2).sum(axis=-1))
    np.testing.assert_allclose(spread, np.std(drawn, axis=0), rtol=0.2, atol=2e-5)
