"""What is not compared: models that fail, runs without poses, names that mean nothing."""

from dataclasses import replace

import numpy as np
import pytest

from odometry.comparison.compare import candidates_named, compare
from odometry.comparison.config import ComparisonConfig
from odometry.errors import ComparisonError, ConfigError, IdentificationError, ParameterError
from odometry.identification.identify import identify
from odometry.recording.run import Run


def test_a_model_that_fails_is_a_row_with_its_reason(grass, quick, bench, tmp_path):
    """`icr_slope` needs tilted ground, a set of ice has no grass, an effect is not known."""
    models = [
        "icr_symmetric",
        "icr_slope",
        bench.write_set(tmp_path / "ice.toml", "icr_symmetric", bench.width, terrain="ice"),
        bench.write_set(
            tmp_path / "more.toml", "icr_symmetric", bench.width, effects=({"name": "a"},)
        ),
    ]
    comparison = compare(grass[:2], models, config=quick)
    place = comparison.places[0]
    rows = {summary.model: summary for summary in comparison.summaries_at(place)}
    assert rows["icr_symmetric"].complete
    expected = {
        "icr_slope": "0 windows are tilted",
        "ice": "no terrain 'grass'; it has ice",
        "more": "effects[0]: effect a/None, expected one of",
    }
    for model, words in expected.items():
        assert rows[model].windows == 0
        assert words in rows[model].reasons[0]
        assert any(model in line and words in line for line in comparison.sentences_at(place))


@pytest.fixture(scope="module")
def in_another_unit(tmp_path_factory, bench):
    """Two runs whose tread speeds are a third of the true ones: alpha would be 3."""
    folder = tmp_path_factory.mktemp("another_unit")
    runs = []
    for seed in range(2):
        speeds = bench.varied(np.random.default_rng(seed), 40.0)
        run = Run.read(bench.write(folder / f"run_{seed}", speeds, seed=seed))
        third = {name: run.odometry[name] / 3 for name in ("v_left", "v_right")}
        columns = {**run.odometry.columns, **third}
        runs.append(replace(run, odometry=replace(run.odometry, columns=columns)))
    return runs


def test_a_fit_at_its_bound_is_evaluated_and_neither_ranked_nor_written(in_another_unit, quick):
    """`identify` refuses its parameters; how it predicts is shown all the same."""
    models = ["differential_drive", "icr_symmetric", "full_linear"]
    comparison = compare(in_another_unit, models, config=quick)
    place = comparison.places[0]
    rows = {summary.model: summary for summary in comparison.summaries_at(place)}
    edged, of_ideal = rows["icr_symmetric"], rows["differential_drive"]
    assert edged.complete
    assert not edged.ranked
    assert edged.windows == of_ideal.windows
    assert edged.means["translation"] < 0.7 * of_ideal.means["translation"]
    (reason,) = edged.not_identified
    assert reason.startswith("alpha ended at its bound 2, and the residuals are")
    assert reason in comparison.remarks_at(place, edged)
    assert rows["differential_drive"].complete
    assert rows["full_linear"].complete  # gamma_12 is 1.5 and has no bound there
    lines = comparison.sentences_at(place)
    assert lines[0].startswith(
        "full_linear has the smallest error over 2 m on grass in translation"
    )
    assert lines[0].endswith("every other ranked model has a larger one.")
    assert not any("icr_symmetric" in line for line in lines[:-1])
    assert lines[-1].startswith("icr_symmetric is not ranked, and its parameters are not written")
    assert "(at a bound: parameters not identified). It predicts all the same" in lines[-1]
    assert f"{edged.means['translation']:.4f} m per m in translation (full_linear" in lines[-1]
    assert {model for _, model in comparison.parameters} == {"differential_drive", "full_linear"}
    with pytest.raises(IdentificationError, match="alpha ended at its bound 2"):
        identify(
            in_another_unit, "icr_symmetric", window_config=quick.training
        ).require_determined()


def test_a_fit_that_leaves_something_open_is_evaluated_and_flagged(tmp_path, bench, quick):
    """Straight ahead, nothing determines the width."""
    runs = [
        Run.read(bench.write(tmp_path / f"run_{i}", np.full((400, 2), 0.5), seed=i))
        for i in range(2)
    ]
    comparison = compare(runs, ["icr_symmetric"], config=quick)
    place = comparison.places[0]
    (summary,) = comparison.summaries_at(place)
    assert summary.complete
    (remark,) = comparison.remarks_at(place, summary)
    assert remark.startswith("not determined in 2 of 2 identifications, such as b_hat")
    table = comparison.parameters["rover", "icr_symmetric"].terrains["grass"]
    assert "not determined: b_hat" in table.source


def test_runs_without_poses_are_left_out(grass, quick):
    blind = replace(grass[0], pose=None)
    comparison = compare([blind, *grass[1:]], ["differential_drive"], config=quick)
    (reason,) = comparison.left_out.values()
    assert "needs pose.csv" in reason
    assert {evaluation.run for evaluation in comparison.evaluations} == {"run_1", "run_2"}
    with pytest.raises(ComparisonError, match=r"no run to compare on\n.*needs pose.csv"):
        compare([blind], ["differential_drive"], config=quick)
    with pytest.raises(ComparisonError, match=r"no run to compare on\n.*needs pose.csv"):
        compare(grass[1:], ["differential_drive"], train=[blind], config=quick)


def test_a_robot_that_training_does_not_know_has_no_model(grass, quick):
    other = replace(grass[2], robot=replace(grass[2].robot, track_width=0.7))
    comparison = compare(grass[:1], ["icr_symmetric"], train=[other], config=quick)
    (summary,) = comparison.summaries_at(comparison.places[0])
    assert summary.reasons == ("run_0: no run of --train is of this robot on this terrain",)


def test_without_a_long_enough_run_there_is_a_row_that_says_so(grass, quick):
    comparison = compare(
        grass[:2], ["differential_drive"], config=replace(quick, horizons_m=(900.0,))
    )
    (summary,) = comparison.summaries_at(comparison.places[0])
    assert summary.windows == 0
    assert "no window of 900 m" in summary.reasons[0]


@pytest.mark.parametrize(
    ("names", "words"),
    [
        (["bicycle"], "no model 'bicycle'; known: differential_drive"),
        ([], "expected one or more"),
        (["icr", "icr"], "each name once"),
    ],
)
def test_names_that_are_no_candidates(names, words):
    with pytest.raises(ComparisonError, match=words):
        candidates_named(names)


def test_a_file_that_is_no_parameter_set(tmp_path):
    (tmp_path / "a.toml").write_text("x = 1")
    with pytest.raises(ParameterError, match="unknown table"):
        candidates_named([str(tmp_path / "a.toml")])


@pytest.mark.parametrize(
    "wrong",
    [
        {"horizons_m": ()},
        {"horizons_m": (0.0,)},
        {"horizons_m": (2.0, 2.0)},
        {"draws": 5},
        {"block_m": 0.0},
    ],
)
def test_settings_that_mean_nothing(wrong):
    with pytest.raises(ConfigError):
        ComparisonConfig(**wrong)
