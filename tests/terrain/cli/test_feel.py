"""`identify-feel` and `feel`: from run folders to a model, and to what a run feels like."""

import csv
import json
import shutil

import pytest
from click.testing import CliRunner

from odometry.feel.model_file import read_feel_model
from odometry.io.run_folder import write_run_folder
from terrain.cli.verbs.feel import feel
from terrain.cli.verbs.identify_feel import identify_feel
from tests.odometry.arrivals import by_chance
from tests.odometry.feel.feel_drives import drive


@pytest.fixture(scope="module")
def folders(tmp_path_factory):
    """Two made terrains, three runs each."""
    root = tmp_path_factory.mktemp("felt")
    for name in ("gravel", "tiles"):
        for seed in range(3):
            run = drive(name, seed, seconds=20.0)
            tables = {"odometry": run.odometry.columns, "imu": run.imu.columns}
            write_run_folder(root / f"{name}_{seed}", run.settings, tables)
    return root


@pytest.fixture(scope="module")
def model(folders):
    runs = [str(path.parent) for path in sorted(folders.glob("*/run.toml"))]
    answer = CliRunner().invoke(identify_feel, [*runs, "--out", str(folders / "my.feel")])
    assert answer.exit_code == 0, answer.output
    return answer, folders / "my.feel"


def invoke(*arguments):
    return CliRunner().invoke(feel, list(map(str, arguments)))


@pytest.mark.slow
def test_what_was_found_with_runs_held_out_is_printed(model):
    answer, file = model
    (row,) = [line for line in answer.stdout.splitlines() if line.startswith("  stretch of 10 s")]
    found = read_feel_model(file)
    assert f"{found.report['stretch']['balanced_accuracy']:.3f}" in row
    assert "speed alone" in answer.stdout
    assert "By run, probabilities are off by" in answer.stdout
    assert answer.stdout.count("exact ones would seem off by") == 3
    assert "Columns that `feel` needs: gyro_x" in answer.stdout
    assert "held out one by one" in answer.stderr


def test_a_run_is_recognised_and_written(model, folders, tmp_path):
    answer = invoke(folders / "gravel_1", "--model", model[1], "--out", tmp_path / "felt")
    assert answer.exit_code == 0, answer.output
    assert "gravel" in answer.stdout.splitlines()[0]
    result = json.loads((tmp_path / "felt" / "result.json").read_text())
    assert max(result["run_probabilities"], key=result["run_probabilities"].get) == "gravel"
    for name in ("feel.csv", "report.html", "figures/feel.png"):
        assert (tmp_path / "felt" / name).is_file()


def test_a_run_whose_rows_came_late_is_felt_at_even_stamps(model, tmp_path):
    run = drive("gravel", 1, seconds=20.0)
    imu = {**run.imu.columns, "t": by_chance(run.imu.stamps_s, 0.02)}
    write_run_folder(
        tmp_path / "late", run.settings, {"odometry": run.odometry.columns, "imu": imu}
    )
    answer = invoke(tmp_path / "late", "--model", model[1], "--out", tmp_path / "felt")
    assert answer.exit_code == 0, answer.output
    assert "they were taken at even stamps" in answer.stderr


def test_several_runs_get_a_folder_each_and_one_table(model, folders, tmp_path):
    runs = [folders / name for name in ("gravel_1", "tiles_2")]
    answer = invoke(*runs, "--model", model[1], "--out", tmp_path / "felt")
    assert answer.exit_code == 0, answer.output
    for run in runs:
        assert (tmp_path / "felt" / run.name / "report.html").is_file()
    with (tmp_path / "felt" / "runs.csv").open(newline="") as stream:
        table = list(csv.DictReader(stream))
    assert [row["run"] for row in table] == ["gravel_1", "tiles_2"]
    assert [row["label"] for row in table] == ["gravel", "tiles"]
    assert [row["true_label"] for row in table] == ["gravel", "tiles"]
    told = [sum(float(row[name]) for name in row if name.startswith("share_")) for row in table]
    assert all(0.9 < one <= 1.0 for one in told)
    alone = invoke(runs[0], "--model", model[1], "--out", tmp_path / "alone")
    assert alone.exit_code == 0
    both = [tmp_path / "alone" / "feel.csv", tmp_path / "felt" / "gravel_1" / "feel.csv"]
    assert both[0].read_bytes() == both[1].read_bytes()
    row = next(line for line in answer.stdout.splitlines() if "tiles_2" in line)
    assert row.split()[1] == "tiles"


def test_a_run_that_cannot_be_used_is_a_row(model, folders, tmp_path):
    shutil.copytree(folders / "gravel_1", tmp_path / "without_imu")
    (tmp_path / "without_imu" / "imu.csv").unlink()
    runs = [tmp_path / "without_imu", folders / "tiles_2"]
    answer = invoke(*runs, "--model", model[1], "--out", tmp_path / "felt")
    assert answer.exit_code == 1
    with (tmp_path / "felt" / "runs.csv").open(newline="") as stream:
        failed, done = csv.DictReader(stream)
    assert (failed["run"], failed["label"], failed["share_tiles"]) == ("without_imu", "", "")
    assert "needs one" in failed["failed"]
    assert "needs one" in answer.output
    assert (done["label"], done["failed"]) == ("tiles", "")
    assert (tmp_path / "felt" / "tiles_2" / "report.html").is_file()
    assert not (tmp_path / "felt" / "without_imu").exists()


def test_no_output_is_left_where_a_run_cannot_be_felt(model, folders, tmp_path):
    shutil.copytree(folders / "gravel_1", tmp_path / "run")
    (tmp_path / "run" / "imu.csv").unlink()
    answer = invoke(tmp_path / "run", "--model", model[1], "--out", tmp_path / "felt")
    assert answer.exit_code == 1
    assert "needs one" in str(answer.exception)
    assert not (tmp_path / "felt").exists()


def test_another_file_is_not_replaced(folders, tmp_path):
    (tmp_path / "thesis.feel").write_text("mine")
    runs = [str(path.parent) for path in folders.glob("*/run.toml")]
    answer = CliRunner().invoke(identify_feel, [*runs, "--out", str(tmp_path / "thesis.feel")])
    assert answer.exit_code == 1
    assert (tmp_path / "thesis.feel").read_text() == "mine"
