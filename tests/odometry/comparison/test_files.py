"""What is written can be read back, and says the same."""

import csv
import json
from dataclasses import replace

import numpy as np
import pytest

from odometry.comparison.compare import compare
from odometry.comparison.file_names import check_file_names, file_name
from odometry.comparison.files import comparison_table, write_comparison
from odometry.errors import ComparisonError
from odometry.parameters import read_parameters
from odometry.recording.run import Run


@pytest.fixture(scope="module")
def compared(grass, quick):
    return compare(grass[:2], ["differential_drive", "icr_symmetric", "icr_slope"], config=quick)


@pytest.fixture(scope="module")
def written(compared, tmp_path_factory):
    out = tmp_path_factory.mktemp("out")
    return out, write_comparison(compared, out)


def test_the_files_that_are_named_are_there(written):
    out, files = written
    names = [file.relative_to(out).as_posix() for file in files]
    assert names == [
        "comparison.json",
        "windows.csv",
        "parameters/differential_drive.toml",
        "parameters/icr_symmetric.toml",
    ]
    assert all(file.is_file() for file in files)


def test_every_window_of_every_model_is_a_row_and_the_means_are_theirs(written):
    out, _ = written
    with (out / "windows.csv").open(newline="") as file:
        rows = list(csv.DictReader(file))
    content = json.loads((out / "comparison.json").read_text())
    (place,) = content["places"]
    for model in place["models"]:
        here = [row for row in rows if row["model"] == model["model"]]
        assert len(here) == model["windows"]
        if here:
            errors = np.array([float(row["translation_m_per_m"]) for row in here])
            assert errors.mean() == pytest.approx(model["translation_m_per_m"]["mean"], abs=1e-8)
            angles = np.array([float(row["rotation_deg_per_m"]) for row in here])
            quartiles = model["rotation_deg_per_m"]["quartiles"]
            np.testing.assert_allclose(np.percentile(angles, [25, 50, 75]), quartiles, atol=1e-8)
    assert {row["run"] for row in rows} == {"run_0", "run_1"}
    assert {float(row["horizon"]) for row in rows} == {2.0}
    assert all(float(row["travel"]) >= 2.0 for row in rows)


def test_a_model_that_failed_has_no_numbers_but_a_reason(written):
    content = json.loads((written[0] / "comparison.json").read_text())
    (slope,) = [m for m in content["places"][0]["models"] if m["model"] == "icr_slope"]
    assert slope["translation_m_per_m"] == {"mean": None, "median": None, "quartiles": None}
    assert "tilted" in slope["reasons"][0]
    assert all("tilted" in split["failed"]["icr_slope"] for split in content["splits"])


def test_the_splits_and_settings_are_written_down(written, compared):
    content = json.loads((written[0] / "comparison.json").read_text())
    assert [(s["judged"], s["seen"]) for s in content["splits"]] == [
        (["run_0"], "run_1"),
        (["run_1"], "run_0"),
    ]
    used = content["splits"][0]["models"]["icr_symmetric"]["parameters"]
    assert used == dict(compared.split_models[0].predictors["icr_symmetric"].values)
    assert content["settings"]["training"]["horizon_m"] is None
    assert content["settings"]["draws"] == 400
    assert len(content["fitness"]) == 4
    assert content["fitness"][0]["mean"] == pytest.approx(compared.fitness[0].fitness.mean)
    assert {row["horizon_m"] for row in content["by_horizon"]} == {0.5, 1.0, 2.0, 5.0, 10.0}


def test_the_parameters_can_be_read_as_a_set(written, compared):
    out, _ = written
    again = read_parameters(out / "parameters" / "icr_symmetric.toml")
    table = compared.parameters["rover", "icr_symmetric"].terrains["grass"]
    assert again.terrains["grass"].values == pytest.approx(dict(table.values))
    np.testing.assert_allclose(again.terrains["grass"].covariance, table.covariance)


def test_errors_by_training_horizon_can_be_read_back(grass, quick, tmp_path):
    config = replace(quick, training_horizons_m=(1.0, 900.0))
    comparison = compare(grass[:2], ["icr_symmetric"], config=config)
    files = write_comparison(comparison, tmp_path)
    assert tmp_path / "training_horizons.csv" in files
    with (tmp_path / "training_horizons.csv").open(newline="") as file:
        rows = {
            (float(row["training_horizon"]), float(row["evaluation_horizon"])): row
            for row in csv.DictReader(file)
        }
    assert len(rows) == 10  # of 1 m and of the 2 m of the comparison; of 900 m there is none
    for each in (each for each in comparison.by_training_horizon if each.training_m == 1.0):
        summary = each.summary
        row = rows[each.training_m, summary.place.horizon_m]
        assert (row["robot"], row["terrain"], row["model"]) == ("rover", "grass", "icr_symmetric")
        assert (float(row["training_horizon"]), int(row["windows"])) == (1.0, summary.windows)
        low, median, high = summary.quartiles["rotation"]
        assert float(row["rotation_deg_per_m_median"]) == pytest.approx(median, abs=1e-8)
        assert float(row["rotation_deg_per_m_quartile_range"]) == pytest.approx(
            high - low, abs=1e-8
        )


def test_robots_have_folders_of_their_own(tmp_path, bench, quick):
    runs = []
    for name in ("rover (old)", "crawler"):
        robot = {"name": name, "track_width": 0.5}
        runs.append(bench.write(tmp_path / name, np.full((200, 2), 0.5), robot=robot))
    comparison = compare([Run.read(run) for run in runs], ["differential_drive"], config=quick)
    files = write_comparison(comparison, tmp_path / "out")[2:]
    assert [file.relative_to(tmp_path / "out").as_posix() for file in files] == [
        "parameters/rover/differential_drive.toml",
        "parameters/crawler/differential_drive.toml",
    ]
    assert read_parameters(files[1]).vehicle == {"name": "crawler", "track_width": 0.5}


def test_robots_whose_folders_would_be_one_are_refused(tmp_path, bench, quick):
    runs = []
    for name in ("rover 1", "rover-1"):
        robot = {"name": name, "track_width": 0.5}
        runs.append(bench.write(tmp_path / name, np.full((200, 2), 0.5), robot=robot))
    with pytest.raises(ComparisonError, match="their files would have one name"):
        compare([Run.read(run) for run in runs], ["differential_drive"], config=quick)


def test_the_same_comparison_gives_the_same_table(grass, quick):
    first, second = (
        json.dumps(comparison_table(compare(grass[:2], ["icr_symmetric"], config=quick)))
        for _ in range(2)
    )
    assert first == second


def test_names_become_parts_of_paths():
    assert file_name("Robot 5 (new)", "sand/gravel") == "Robot_5_new_sand_gravel"
    assert file_name("../..") == "unnamed"


@pytest.mark.parametrize(
    ("places", "said"),
    [
        ([("rover 1", "sand"), ("rover-1", "mud")], "'rover 1' and 'rover-1' differ in signs"),
        ([("a", "wet grass"), ("a", "Wet_grass")], "'a' on 'wet grass' and 'a' on 'Wet_grass'"),
        ([("a", "b c"), ("a b", "c")], "'a' on 'b c' and 'a b' on 'c'"),
    ],
)
def test_names_whose_files_would_replace_each_other_are_refused(places, said):
    with pytest.raises(ComparisonError, match=said):
        check_file_names(places)


def test_other_names_have_files_of_their_own():
    check_file_names([("a", "wet grass"), ("a", "wet grass 2"), ("b", "wet grass")])
