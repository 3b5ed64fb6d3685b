"""Intervals against closed forms, and how often they hold a known truth."""

import numpy as np
import pytest

from odometry.comparison.config import ComparisonConfig
from odometry.comparison.statistics import Interval, differences, mean_interval
from tests.odometry.comparison.written_errors import PLACE, evaluation


def interval(values, runs, block, draws=4000, seed=0):
    return mean_interval(values, runs, block, draws, np.random.default_rng(seed))


def width(found):
    """Half width in standard deviations of a normal interval."""
    return (found.high - found.low) / 2 / 1.96


def test_windows_of_one_run_that_are_independent_have_the_normal_interval(rng):
    """Blocks of one: sigma / sqrt(K)."""
    values = rng.normal(0.3, 2.0, 400)
    found = interval(values, np.zeros(400), 1)
    assert found.mean == pytest.approx(values.mean())
    assert width(found) == pytest.approx(values.std() / 20, rel=0.05)
    assert (found.low + found.high) / 2 == pytest.approx(values.mean(), abs=0.02)


def test_neighbours_that_are_alike_count_once(rng):
    """Five equal neighbours: as if there were K / 5 windows. Of moving blocks of five, one holds
    i of a group and 5 - i of the next: mean variance (25 + 2 (1 + 4 + 9 + 16)) / 125 of a group.
    """
    groups = rng.normal(0, 1, 200)
    values = np.repeat(groups, 5)
    expected = np.sqrt(
        groups.var() / 200 * (25 + 2 * sum((i * i + (5 - i) ** 2) / 2 for i in range(1, 5))) / 125
    )
    assert width(interval(values, np.zeros(1000), 5)) == pytest.approx(expected, rel=0.05)
    blind = width(interval(values, np.zeros(1000), 1))
    assert blind == pytest.approx(groups.std() / np.sqrt(1000), rel=0.05)
    assert blind < 0.6 * expected


def test_what_differs_from_run_to_run_widens_the_interval(rng):
    """R runs of n windows: the variance of the runs' means, plus that of windows, over R."""
    runs = np.repeat(np.arange(12), 50)
    values = rng.normal(0, 1, 12)[runs] + rng.normal(0, 0.5, 600)
    means = values.reshape(12, 50).mean(axis=1)
    within = values.reshape(12, 50).var(axis=1).mean() / 50
    expected = np.sqrt((means.var() + within) / 12)
    assert width(interval(values, runs, 1)) == pytest.approx(expected, rel=0.05)
    assert width(interval(values, np.zeros(600), 1)) < 0.4 * expected


def test_the_interval_holds_the_truth_about_as_often_as_it_says():
    """Six runs with their own means, windows equal within blocks of four."""
    held = 0
    for seed in range(200):
        rng = np.random.default_rng(seed)
        runs = np.repeat(np.arange(6), 40)
        values = rng.normal(0, 0.3, 6)[runs] + np.repeat(rng.normal(0, 1, 60), 4)
        held += interval(values, runs, 5, draws=500, seed=seed).holds_zero
    assert 0.88 <= held / 200 <= 0.99


def test_a_run_with_more_windows_counts_more():
    """Ten runs of eighteen windows of 0, ten runs of two windows of 1: a mean of 0.1."""
    sizes = [18] * 10 + [2] * 10
    values, runs = np.repeat([0.0, 1.0], [180, 20]), np.repeat(np.arange(20), sizes)
    found = interval(values, runs, 1)
    assert found.mean == pytest.approx(0.1)
    assert 0.03 < found.low < 0.1 < found.high < 0.25


def test_a_short_run_still_has_five_blocks():
    values = np.arange(10.0)
    assert width(interval(values, np.zeros(10), 100)) > 0.5


@pytest.mark.parametrize("count", [2, 4])
def test_few_windows_are_no_error(count):
    found = interval(np.full(count, 0.2), np.zeros(count), 5)
    assert (found.mean, found.low, found.high) == pytest.approx((0.2, 0.2, 0.2))


def test_one_window_has_no_interval():
    assert interval(np.array([0.2]), np.zeros(1), 5) == Interval(0.2, -np.inf, np.inf)


@pytest.mark.parametrize("count", [2, 3, 6, 9])
def test_few_windows_have_the_interval_of_student(count):
    """Percentiles alone hold the truth in 50, 70, 86 and 90 %."""
    held = 0
    for seed in range(400):
        values = np.random.default_rng(seed).normal(0, 1, count)
        held += interval(values, np.zeros(count), 5, draws=400, seed=seed).holds_zero
    assert 0.92 <= held / 400 <= 0.99


def test_differences_of_arithmetic_alone_are_none():
    """Two forms of one model differ in the last digit, and may do so always the same way."""
    found = interval(np.full(40, 3e-16), np.repeat([0, 1], 20), 3)
    assert (found.mean, found.low, found.high) == (0.0, 0.0, 0.0)


@pytest.mark.parametrize("count", [1, 2])
def test_two_windows_have_a_difference_and_one_has_none(count):
    pair = evaluation("east", icr=[0.1] * count, differential_drive=[0.3] * count)
    found = differences(PLACE, [pair], ["icr", "differential_drive"], ComparisonConfig())
    assert [each.windows for each in found] == [2, 2] * (count - 1)


def test_the_seed_decides():
    values = np.random.default_rng(1).normal(0, 1, 50)
    runs = np.repeat([0, 1], 25)
    assert interval(values, runs, 3) == interval(values, runs, 3)
    assert interval(values, runs, 3) != interval(values, runs, 3, seed=1)


@pytest.mark.parametrize(
    ("low", "high", "holds"), [(-1, 1, True), (0, 1, True), (-1, 0, True), (0.1, 1, False)]
)
def test_an_interval_that_holds_zero(low, high, holds):
    assert Interval(0.5, low, high).holds_zero is holds


@pytest.mark.parametrize(("count", "deviations"), [(2, 12.706), (3, 4.303), (6, 2.571)])
def test_runs_that_differ_for_certain_have_the_interval_of_student(count, deviations):
    """Every window of a run has its value: only the values of runs are drawn from anything."""
    of_runs = np.arange(count) % 3 + 0.5 * np.arange(count)
    found = interval(np.repeat(of_runs, 50), np.repeat(np.arange(count), 50), 5)
    half = deviations * of_runs.std(ddof=1) / np.sqrt(count)
    assert found.high - found.mean == pytest.approx(half, rel=1e-3)
    assert found.mean - found.low == pytest.approx(half, rel=1e-3)


@pytest.mark.parametrize("unit", [1e-3, 57.3])
def test_another_unit_gives_the_same_interval(unit):
    """Also where runs differ about as much as their windows explain."""
    rng = np.random.default_rng(4)
    runs = np.repeat(np.arange(3), 30)
    values = rng.normal(0, 1, 90) + rng.normal(0, 0.4, 3)[runs]
    in_one, in_other = interval(values, runs, 5), interval(unit * values, runs, 5)
    assert [in_other.mean, in_other.low, in_other.high] == pytest.approx(
        [unit * in_one.mean, unit * in_one.low, unit * in_one.high]
    )


@pytest.mark.parametrize("count", [2, 3])
def test_few_runs_that_differ_hold_the_truth(count):
    """Runs differ three times as much as their windows explain: 0.82 and 0.89 when it was made."""
    held = 0
    for seed in range(200):
        rng = np.random.default_rng([5, seed])
        of_runs = rng.normal(0, 3 / np.sqrt(30), count)
        values = rng.normal(0, 1, 30 * count) + np.repeat(of_runs, 30)
        found = interval(values, np.repeat(np.arange(count), 30), 5, draws=300, seed=seed)
        held += found.holds_zero
    assert held / 200 > 0.78
