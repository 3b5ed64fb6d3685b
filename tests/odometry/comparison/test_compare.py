"""Comparisons of models whose truth is known."""

from dataclasses import replace

import numpy as np
import pytest

from odometry.comparison.candidates import IdentifiedModel
from odometry.comparison.compare import compare
from odometry.comparison.config import ComparisonConfig
from odometry.comparison.statistics import between
from odometry.identification.identify import identify
from odometry.identification.start import SolverConfig
from odometry.models.catalogue import MODELS
from odometry.parameters import ParameterSet, TerrainParameters, write_parameters
from odometry.recording.run import Run
from odometry.windows.config import WindowConfig


@pytest.fixture(scope="module")
def compared(grass, quick):
    return compare(grass, config=quick)


def test_models_that_are_the_same_cannot_be_distinguished_and_a_wrong_one_is(
    grass, quick, bench, tmp_path
):
    """A robot whose ICRs are symmetric: `icr` and `icr_symmetric` predict the same motion."""
    models = [
        bench.write_set(tmp_path / "icr.toml", "icr", bench.symmetric),
        bench.write_set(tmp_path / "width.toml", "icr_symmetric", bench.width),
        bench.write_set(tmp_path / "wrong.toml", "icr_symmetric", {"alpha": 1.0, "b_hat": 0.9}),
    ]
    comparison = compare(grass, models, config=quick)
    found = comparison.differences_at(comparison.places[0])
    for quantity in (0, 1):
        of_quantity = found[quantity::2]
        same = between(of_quantity, "icr", "width").interval
        assert (same.low, same.mean, same.high) == pytest.approx((0, 0, 0), abs=1e-9)
        assert between(of_quantity, "icr", "wrong").interval.high < 0
    lines = comparison.sentences_at(comparison.places[0])
    assert "wrong" not in " ".join(lines)
    assert sum("cannot be distinguished" in line for line in lines) == 2
    for summary in comparison.summaries_at(comparison.places[0]):
        (remark,) = comparison.remarks_at(comparison.places[0], summary)
        assert "may have been identified on these very runs" in remark


def test_a_set_in_another_unit_is_said(grass, quick, bench, tmp_path):
    in_mm = {"alpha": 1.0, "b_hat": 900.0}
    file = bench.write_set(tmp_path / "mm.toml", "icr_symmetric", in_mm)
    comparison = compare(grass, [file], config=quick)
    (summary, *_) = comparison.summaries_at(comparison.places[0])
    assert any(
        "as if 900 m wide" in one for one in comparison.remarks_at(comparison.places[0], summary)
    )


def test_parameter_sets_are_those_of_identify(grass, quick):
    """With intervals of few degrees of freedom taken into the covariance."""
    compared = compare(grass, ["icr_symmetric"], config=quick)
    ((_, of_compare),) = compared.parameters.items()
    of_identify = identify(
        grass, "icr_symmetric", window_config=quick.training, solver_config=quick.solver
    ).to_parameter_set()
    for name, table in of_identify.terrains.items():
        same = of_compare.terrains[name]
        assert same.values == pytest.approx(table.values, rel=1e-9)
        np.testing.assert_allclose(same.covariance, table.covariance, rtol=1e-6)


def test_identified_models_find_the_truth_and_the_ideal_one_does_not(compared, bench):
    place = compared.places[0]
    means = {s.model: s.means for s in compared.summaries_at(place)}
    for model in ("icr", "icr_symmetric"):
        assert means[model]["translation"] < 0.02 < means["differential_drive"]["translation"]
    found = compared.differences_at(place)[0::2]
    assert between(found, "icr", "differential_drive").interval.high < 0
    table = compared.parameters["rover", "icr_symmetric"].terrains["grass"]
    assert table.values == pytest.approx(bench.width, abs=0.01)
    assert table.covariance_order == ("alpha", "b_hat")
    assert "run_0, run_1, run_2" in table.source
    ideal = compared.parameters["rover", "differential_drive"].terrains["grass"]
    assert ideal.values == {"track_width": bench.track_width}


def test_every_horizon_is_evaluated_and_only_those_requested_are_compared(compared):
    horizons = {evaluation.horizon_m for evaluation in compared.evaluations}
    assert horizons == {0.5, 1.0, 2.0, 5.0, 10.0}
    assert {each.place.horizon_m for each in compared.differences} == {2.0}


def test_fitness_is_that_of_a_plain_loop_over_the_whole_run(compared, grass, bench):
    run = grass[0]
    ideal = bench.symmetric | {"y_left": bench.track_width / 2, "y_right": -bench.track_width / 2}
    measured = run.pose.stack("x", "y", "yaw")
    at, errors = measured[0], []
    for i, (left, right) in enumerate(run.odometry.stack("v_left", "v_right")):
        if i % 2 == 0:
            errors.append(at - measured[i // 2])
        at = bench.advance(at, left, right, ideal, bench.step_s)
    errors = np.array(errors)
    errors[:, 2] = np.unwrap(errors[:, 2])
    (found,) = [
        f.fitness for f in compared.fitness if (f.run, f.model) == ("run_0", "differential_drive")
    ]
    expected = (errors**2).mean(axis=0)
    assert (found.x_m2, found.y_m2, found.yaw_rad2) == pytest.approx(tuple(expected), abs=1e-4)
    assert (found.poses, found.heights) == (len(errors), 0)
    assert len(compared.fitness) == 9


def test_fitness_changes_parameters_with_the_terrain(tmp_path, bench, quick):
    """Given widths of 0.6 m on grass, 1 m on ice, in turn along one run."""
    speeds = bench.varied(np.random.default_rng(4), 20.0)
    names = (["grass"] * 70 + ["ice"] * 60) * 4
    run = Run.read(bench.write(tmp_path / "r", speeds, terrain_column=names[: len(speeds)]))
    widths = {"grass": 0.6, "ice": 1.0}
    file = tmp_path / "set.toml"
    tables = {
        ground: TerrainParameters("icr_symmetric", {"alpha": 1.0, "b_hat": width})
        for ground, width in widths.items()
    }
    write_parameters(file, ParameterSet(tables))
    (found,) = compare([run], [str(file)], config=quick).fitness
    measured = run.pose.stack("x", "y", "yaw")
    at, errors = measured[0], []
    for i, (left, right) in enumerate(speeds):
        if i % 2 == 0:
            errors.append(at[:2] - measured[i // 2, :2])
        half = widths[names[i]] / 2
        icrs = bench.symmetric | {"y_left": half, "y_right": -half}
        at = np.array(bench.advance(at, left, right, icrs, bench.step_s))
    expected = np.mean(np.square(errors), axis=0)
    assert (found.fitness.x_m2, found.fitness.y_m2) == pytest.approx(tuple(expected), abs=1e-4)


def test_the_only_run_of_a_terrain_is_evaluated_by_halves(grass, quick):
    comparison = compare(grass[:1], ["icr_symmetric"], config=quick)
    assert {evaluation.training_runs for evaluation in comparison.evaluations} == {
        "the first half of the run",
        "the second half of the run",
    }
    values = [p.predictors["icr_symmetric"].values["b_hat"] for p in comparison.split_models]
    assert values[0] != values[1]
    assert len(comparison.fitness) == 1


def test_a_fit_to_all_runs_determines_where_to_search_and_nothing_else(grass, quick):
    """The models of each split are those that a search from far finds."""
    near = compare(grass, ["icr"], config=replace(quick, solver=SolverConfig(starts=4)))
    for models in near.split_models:
        alone = IdentifiedModel(MODELS["icr"]).on(models.split, near.config)
        found = models.predictors["icr"]
        assert found.values == pytest.approx(dict(alone.values), abs=1e-5)
        np.testing.assert_allclose(found.covariance, alone.covariance, rtol=1e-3)
        assert found.values != near.parameters["rover", "icr"].terrains["grass"].values


def test_models_are_identified_on_training_runs_and_evaluated_on_the_others(grass, quick):
    comparison = compare(grass[:2], ["icr_symmetric"], train=grass[2:], config=quick)
    assert {(j.run, j.training_runs) for j in comparison.evaluations} == {
        ("run_0", "run_2"),
        ("run_1", "run_2"),
    }
    (models,) = comparison.split_models
    table = comparison.parameters["rover", "icr_symmetric"].terrains["grass"]
    assert table.values == models.predictors["icr_symmetric"].values


def test_terrains_within_one_run_have_models_of_their_own(tmp_path, bench, quick):
    """Half of each run on another ground, where the robot turns less."""
    runs = []
    for seed in range(2):
        speeds = bench.varied(np.random.default_rng(seed), 40.0)
        names = ["grass"] * 400 + ["ice"] * 400
        run = bench.write(tmp_path / f"run_{seed}", speeds, seed=seed, terrain_column=names)
        runs.append(Run.read(run))
    comparison = compare(runs, ["icr_symmetric"], config=quick)
    assert comparison.robots_and_terrains == (("rover", "grass"), ("rover", "ice"))
    assert set(comparison.parameters["rover", "icr_symmetric"].terrains) == {"grass", "ice"}
    assert {f.run for f in comparison.fitness} == {"run_0", "run_1"}


def test_a_candidate_of_ones_own_may_hold_values_and_see_fewer_windows(grass, quick):
    """Every second window or so, from the first to the last of what may be fitted."""
    held = IdentifiedModel(MODELS["icr_symmetric"], {"b_hat": 0.7}, most_windows=9)
    comparison = compare(grass, [held], config=quick)
    for models in comparison.split_models:
        predictor = models.predictors["icr_symmetric"]
        assert predictor.values["b_hat"] == 0.7
        assert predictor.covariance_order == ("alpha",)
        assert "from 9 windows of" in predictor.source
    few = IdentifiedModel(MODELS["icr_symmetric"], most_windows=9)
    assert few.on(comparison.split_models[0].split, quick).values["b_hat"] == pytest.approx(
        0.8, abs=0.02
    )


def test_settings_reach_the_identification(grass):
    config = ComparisonConfig(
        training=WindowConfig(horizon_m=4.0), solver=SolverConfig(starts=1), draws=100
    )
    comparison = compare(grass[:2], ["icr_symmetric"], config=config)
    counts = [
        p.predictors["icr_symmetric"].source.split(" windows")[0] for p in comparison.split_models
    ]
    usual = compare(grass[:2], ["icr_symmetric"], config=replace(config, training=WindowConfig()))
    others = [p.predictors["icr_symmetric"].source.split(" windows")[0] for p in usual.split_models]
    assert counts != others
