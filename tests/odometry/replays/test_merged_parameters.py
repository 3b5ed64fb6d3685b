"""One parameter set of what several runs learned."""

import numpy as np
import pytest
from scipy.stats import chi2

from odometry.parameters import ParameterSet, TerrainParameters, read_parameters, write_parameters
from odometry.replays.learned_parameters import learned_by_runs, merged_terrain

NAMES = ("y_left", "y_right", "x_icr")
TRUE = np.array([0.4, -0.38, 0.02])


def table(values, covariance, source="learned"):
    of = dict(zip(NAMES, map(float, values), strict=True)) | {"alpha_left": 1.0, "alpha_right": 1.0}
    return TerrainParameters("icr", of, NAMES, np.asarray(covariance), source)


def drawn(rng, runs, spread=0.0):
    """Runs with errors of random covariances about values that spread."""
    found = {}
    for number in range(runs):
        root = rng.normal(0, 0.01, (3, 3))
        covariance = root @ root.T + 1e-6 * np.eye(3)
        values = TRUE + rng.normal(0, spread, 3) + rng.multivariate_normal(np.zeros(3), covariance)
        found[f"run_{number}"] = table(values, covariance)
    return found


def mean_of(merged):
    return np.array([merged.parameters.values[name] for name in NAMES])


def test_one_run_stays_as_it_is_and_determines_no_spread(rng):
    tables = drawn(rng, 1)
    merged = merged_terrain(tables)
    assert merged.parameters is tables["run_0"]
    assert (merged.spread, merged.disagree) == ({}, ())


def test_runs_that_agree_exactly_are_fused_as_one_filter_would():
    """The mean of independent estimates by their information, in any order."""
    covariances = [np.diag([1.0, 4.0, 2.0]), np.diag([2.0, 1.0, 9.0]), np.eye(3)]
    tables = {str(k): table(TRUE + 1e-3 * k, c) for k, c in enumerate(covariances)}
    information = sum(map(np.linalg.inv, covariances))
    weighted = sum(np.linalg.inv(c) @ (TRUE + 1e-3 * k) for k, c in enumerate(covariances))
    for order in (tables, dict(reversed(tables.items()))):
        merged = merged_terrain(order)
        assert mean_of(merged) == pytest.approx(np.linalg.solve(information, weighted))
        assert merged.parameters.covariance == pytest.approx(np.linalg.inv(information))
        assert merged.spread == dict.fromkeys(NAMES, 0.0)


@pytest.mark.parametrize(
    ("runs", "spread"), [(2, 0.0), (2, 0.05), (5, 0.01), (20, 0.0), (20, 0.05)]
)
def test_a_next_run_lies_where_the_covariance_says(rng, runs, spread):
    """In nine of ten cases, or more, whatever the spread: runs of unequal covariances."""
    within = []
    for _ in range(60):
        merged = merged_terrain(drawn(rng, runs, spread))
        off = TRUE + rng.normal(0, spread, 3) - mean_of(merged)
        squared = off @ np.linalg.solve(merged.parameters.covariance, off)
        within.append(squared < chi2.ppf(0.9, 3))
    assert np.mean(within) > 0.83


def test_two_runs_give_no_spread_and_a_covariance_that_covers_both():
    tables = {"a": table(TRUE, 1e-6 * np.eye(3)), "b": table(TRUE + 0.2, 1e-6 * np.eye(3))}
    merged = merged_terrain(tables)
    assert merged.spread == {}
    assert mean_of(merged) == pytest.approx(TRUE + 0.1)
    assert np.all(np.sqrt(np.diag(merged.parameters.covariance)) > 0.2)
    (said,) = merged.disagree
    assert said.startswith("a and b disagree")
    assert "cannot be estimated" in said


def test_a_run_far_from_the_others_is_named_with_what_is_far(rng):
    for runs in (3, 4, 10):
        tables = {
            str(k): table(TRUE + rng.normal(0, 1e-3, 3), 1e-6 * np.eye(3)) for k in range(runs)
        }
        assert merged_terrain(tables).disagree == ()
        tables["odd"] = table(TRUE + np.array([0, 0, 0.5]), 1e-6 * np.eye(3))
        (said,) = merged_terrain(tables).disagree
        assert said.startswith("odd: x_icr 0.52")


def test_a_run_far_from_the_others_widens_the_covariance(rng):
    tables = {str(k): table(TRUE + rng.normal(0, 1e-3, 3), 1e-6 * np.eye(3)) for k in range(5)}
    tables["odd"] = table(TRUE + np.array([0, 0, 0.5]), 1e-6 * np.eye(3))
    sigmas = np.sqrt(np.diag(merged_terrain(tables).parameters.covariance))
    assert sigmas[2] > 0.15
    assert sigmas[0] < 0.01


def test_runs_that_began_alike_are_no_surer_together_than_one():
    covariance = np.diag([1.0, 2.0, 3.0])
    tables = {str(k): table(TRUE, covariance) for k in range(7)}
    assert merged_terrain(tables).parameters.covariance == pytest.approx(covariance / 7)
    alike = merged_terrain(tables, began_alike=True)
    assert alike.parameters.covariance == pytest.approx(covariance)


def test_tables_that_were_handed_on_are_not_learned(rng, tmp_path):
    before = ParameterSet({"grass": drawn(rng, 1)["run_0"], "ice": drawn(rng, 1)["run_0"]})
    write_parameters(tmp_path / "set.toml", before)
    again = read_parameters(tmp_path / "set.toml")
    changed = table(TRUE, np.eye(3), "learned by terrain-odometry from 5 poses of a")
    after = {"a": ParameterSet({**again.terrains, "grass": changed}), "b": again}
    assert learned_by_runs(before, after) == {"grass": {"a": changed}}
