"""`compare`: from run folders to tables, sentences and a page."""

import json
import re
from pathlib import Path

import numpy as np
import pytest
from click.testing import CliRunner

from odometry.errors import OutputError
from odometry.io.run_folder import write_run_folder
from terrain.cli.verbs.compare import compare


def make(folder, seed, terrain="grass"):
    """A run of an ideal robot 0.8 m wide on a track of 0.5 m, by a loop of straight steps."""
    rng = np.random.default_rng(seed)
    speeds = np.repeat(rng.uniform(-0.5, 1.2, (12, 2)), 30, axis=0)
    t = 0.05 * np.arange(len(speeds))
    poses = [np.zeros(3)]
    for left, right in speeds[:-1]:
        x, y, yaw = poses[-1]
        forward, turn = (left + right) / 2 * 0.05, (right - left) / 0.8 * 0.05
        heading = yaw + turn / 2
        poses.append(
            np.array([x + np.cos(heading) * forward, y + np.sin(heading) * forward, yaw + turn])
        )
    x, y, yaw = (np.array(poses) + rng.normal(0, 0.003, (len(poses), 3))).T
    settings = {"robot": {"name": "rover", "track_width": 0.5}}
    if terrain:
        settings["run"] = {"terrain": terrain}
    odometry = {"t": t, "v_left": speeds[:, 0], "v_right": speeds[:, 1]}
    write_run_folder(
        folder, settings, {"odometry": odometry, "pose": {"t": t, "x": x, "y": y, "yaw": yaw}}
    )
    return str(folder)


@pytest.fixture
def runs(tmp_path):
    return [make(tmp_path / f"run_{i}", i) for i in range(2)]


def invoke(*arguments):
    return CliRunner().invoke(compare, list(map(str, arguments)))


def test_windows_that_were_left_out_are_counted(runs, tmp_path):
    """Five seconds without poses in one run."""
    file = tmp_path / "run_0" / "pose.csv"
    header, *lines = file.read_text().splitlines()
    kept = [line for line in lines if not 8 < float(line.split(",")[0]) < 13]
    file.write_text("\n".join([header, *kept]) + "\n")
    answer = invoke(*runs, "--model", "icr_symmetric", "--out", tmp_path / "out")
    wanted = r"^  Note: in these runs \d+ windows? left out: gap of pose.csv \(\d+\)$"
    assert re.search(wanted, answer.stdout, re.M)


def test_a_row_for_each_model_then_what_it_means(runs, tmp_path):
    out = tmp_path / "out"
    answer = invoke(
        *runs, "--model", "differential_drive", "--model", "icr_symmetric", "--out", out
    )
    assert answer.exit_code == 0, answer.output
    content = json.loads((out / "comparison.json").read_text())
    for model in content["places"][0]["models"]:
        (row,) = [
            line.split() for line in answer.stdout.splitlines() if f" {model['model']} " in line
        ][:1]
        assert row[:5] == ["rover", "grass", "2", "m", model["model"]]
        assert float(row[6]) == pytest.approx(model["translation_m_per_m"]["mean"], abs=5e-5)
        assert float(row[7]) == pytest.approx(model["translation_m_per_m"]["median"], abs=5e-5)
        assert float(row[8]) == pytest.approx(model["rotation_deg_per_m"]["mean"], abs=5e-5)
        assert float(row[9]) == pytest.approx(model["rotation_deg_per_m"]["median"], abs=5e-5)
    assert "rover on grass: run_0, by run_1\n" in answer.stdout
    assert "icr_symmetric has the smallest error over 2 m on grass in translation" in answer.stdout
    assert answer.stdout.rstrip().endswith(f"Next: open {out / 'report.html'}")
    wrote = answer.stdout.split(f"Wrote to {out}: ")[1].splitlines()[0].split(", ")
    assert set(wrote) == {
        file.relative_to(out).as_posix() for file in out.rglob("*") if file.is_file()
    }


@pytest.mark.slow
def test_options_reach_the_comparison(runs, tmp_path):
    """Runs without a named ground, training runs, horizons, seed."""
    plain = [make(tmp_path / f"plain_{i}", 5 + i, terrain=None) for i in range(2)]
    out = tmp_path / "out"
    options = ["--terrain", "grass", "--horizon", "3", "--evaluation-horizon", "1"]
    options += ["--evaluation-horizon", "4", "--seed", "7", "--model", "icr_symmetric"]
    answer = invoke(plain[0], "--train", runs[0], *options, "--out", out)
    assert answer.exit_code == 0, answer.output
    content = json.loads((out / "comparison.json").read_text())
    assert content["settings"]["training"]["horizon_m"] == 3.0
    assert content["settings"]["horizons_m"] == [1.0, 4.0]
    assert content["settings"]["seed"] == content["settings"]["solver"]["seed"] == 7
    assert [place["horizon_m"] for place in content["places"]] == [1.0, 4.0]
    (split,) = content["splits"]
    assert (split["ground"], split["judged"], split["seen"]) == ("grass", ["plain_0"], "run_0")
    again = tmp_path / "again"
    invoke(plain[0], "--train", runs[0], *options, "--out", again)
    for file in ("comparison.json", "windows.csv", "report.html"):
        assert (out / file).read_bytes() == (again / file).read_bytes()


def test_training_horizons_are_shown_and_written(runs, tmp_path):
    out = tmp_path / "out"
    options = ["--model", "icr_symmetric", "--training-horizon", "1", "--training-horizon", "4"]
    answer = invoke(*runs, *options, "--out", out)
    assert answer.exit_code == 0, answer.output
    assert "icr_symmetric, translation, identified over windows of 1, 2 or 4 m: " in answer.stdout
    assert "training_horizons.csv" in answer.stdout
    assert (out / "figures" / "training_horizons_rover_grass_icr_symmetric.png").is_file()
    assert "training and evaluation horizon" in (out / "report.html").read_text(encoding="utf-8")


def test_the_parameters_it_writes_can_be_compared_again(runs, tmp_path):
    first, second = tmp_path / "first", tmp_path / "second"
    assert invoke(*runs, "--model", "icr_symmetric", "--out", first).exit_code == 0
    found = first / "parameters" / "icr_symmetric.toml"
    answer = invoke(*runs, "--model", found, "--out", second)
    assert answer.exit_code == 0, answer.output
    content = json.loads((second / "comparison.json").read_text())
    assert content["models"] == ["icr_symmetric"]
    assert not (second / "parameters").exists()
    assert "the runs on which the models were identified" not in answer.stdout  # nothing was


def test_a_set_of_another_terrain_says_once_what_to_do(runs, tmp_path):
    """The only run is held out by halves, and the reason is that of both."""
    file = tmp_path / "ice.toml"
    text = '[terrain.ice]\nmodel = "icr_symmetric"\nalpha = 1.0\nb_hat = 0.8\n'
    file.write_text(text)
    models = ("--model", file, "--model", "differential_drive")
    answer = invoke(runs[0], *models, "--out", tmp_path / "out")
    assert answer.exit_code == 0, answer.output
    assert answer.stdout.count("the set has no terrain 'grass'; it has ice (rename the table") == 1
    assert "not ranked, see below" in answer.stdout


def test_a_run_without_poses_is_left_out_with_a_note(runs, tmp_path):
    (tmp_path / "run_1" / "pose.csv").unlink()
    answer = invoke(*runs, "--model", "differential_drive", "--out", tmp_path / "out")
    assert answer.exit_code == 0, answer.output
    assert "Note: left out:" in answer.stderr
    assert "run_1" in answer.stderr


def test_an_unknown_model_is_a_usage_error(runs, tmp_path):
    answer = invoke(*runs, "--model", "bicycle", "--out", tmp_path / "out")
    assert answer.exit_code == 2
    assert "'bicycle'; known: differential_drive" in answer.stderr
    assert not (tmp_path / "out").exists()


def test_a_run_folder_is_no_place_for_results(runs):
    answer = invoke(*runs, "--out", runs[1])
    with pytest.raises(OutputError, match="choose another folder"):
        raise answer.exception


def test_a_fit_at_its_bound_is_a_marked_row_and_no_parameters(runs, tmp_path):
    """Tread speeds a third of the true ones: `identify` refuses alpha = 2."""
    for folder in runs:
        file = Path(folder) / "odometry.csv"
        header, *lines = file.read_text().splitlines()
        rows = np.array([line.split(",") for line in lines], dtype=float)
        rows[:, 1:] /= 3
        text = [header, *(",".join(map(str, row)) for row in rows.tolist())]
        file.write_text("\n".join(text) + "\n")
    out = tmp_path / "out"
    models = ("--model", "icr_symmetric", "--model", "differential_drive")
    answer = invoke(*runs, *models, "--out", out)
    assert answer.exit_code == 0, answer.output
    row = next(line for line in answer.stdout.splitlines() if " icr_symmetric " in line)
    assert row.endswith("at a bound: parameters not identified")
    (place,) = json.loads((out / "comparison.json").read_text())["places"]
    edged = place["models"][0]
    assert float(row.split()[6]) == pytest.approx(edged["translation_m_per_m"]["mean"], abs=5e-5)
    assert edged["not_identified"][0].startswith("alpha ended at its bound 2")
    assert not (out / "parameters" / "icr_symmetric.toml").exists()
    page = (out / "report.html").read_text()
    assert "icr_symmetric (at a bound: parameters not identified)" in page
