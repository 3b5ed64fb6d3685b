"""`run`: the options reach the job, and the command says what it wrote."""

import csv
import json
import shutil
from copy import copy

import numpy as np
import pytest
from click.testing import CliRunner

from odometry.errors import OdometryError
from terrain.classification.confidence import AnswerConfidence
from terrain.cli.verbs.run import run


def invoke(*arguments):
    """The verb in this process; errors of the project come through as they are."""
    return CliRunner().invoke(run, [str(argument) for argument in arguments])


def content_of(out):
    return json.loads((out / "result.json").read_text())


@pytest.mark.slow
def test_with_a_model_the_terrain_is_seen(across_run, model_file, tmp_path):
    out = tmp_path / "out"
    answer = invoke(across_run, "--out", out, "--model", model_file, "--terrain", "gravel")
    assert answer.exit_code == 0, answer.output
    assert [s["terrain"] for s in content_of(out)["switches"]] == ["boards", "gravel"]
    (wrote,) = [line for line in answer.output.splitlines() if line.startswith("Wrote to ")]
    names = wrote.split(": ", 1)[1].split(", ")
    found = [f.relative_to(out).as_posix() for f in out.rglob("*") if f.is_file()]
    assert sorted(names) == sorted(found)
    assert {"report.html", "terrain.csv"} <= set(names)
    assert "odometer" in answer.output
    counts = content_of(out)["sightings"]
    assert f"{counts['boards']} boards" in answer.output
    assert str(out / "report.html") in answer.output.split("Next: ")[1]


@pytest.mark.usefixtures("no_report")
def test_no_vision_and_terrain_keep_one_terrain(across_run, model_file, tmp_path):
    out = tmp_path / "out"
    answer = invoke(
        across_run, "--out", out, "--model", model_file, "--no-vision", "--terrain", "mud"
    )
    assert answer.exit_code == 0, answer.output
    content = content_of(out)
    assert (content["vision"], content["initial_terrain"]) == (False, "mud")
    assert not (out / "terrain.csv").exists()


@pytest.mark.usefixtures("no_report")
def test_the_terrain_comes_from_the_source_that_is_named(across_run, model_file, tmp_path):
    """The labels of odometry.csv; images stay closed, and no model is needed."""
    folder = tmp_path / "run"
    shutil.copytree(across_run, folder)
    header, *rows = (folder / "odometry.csv").read_text().split()
    names = ["mud"] * (len(rows) // 2) + ["sand"] * (len(rows) - len(rows) // 2)
    lines = [f"{row},{name}" for row, name in zip(rows, names, strict=True)]
    (folder / "odometry.csv").write_text("\n".join([f"{header},terrain", *lines]) + "\n")
    out = tmp_path / "out"
    answer = invoke(folder, "--out", out, "--model", model_file, "--source", "labels")
    assert answer.exit_code == 0, answer.output
    content = content_of(out)
    assert (content["vision"], content["initial_terrain"]) == (False, "mud")
    assert [switch["terrain"] for switch in content["switches"]] == ["sand"]
    assert content["learned"] == {}  # on a straight
    assert "learned.toml" not in answer.output
    assert "no vision without --model" not in answer.output


@pytest.mark.usefixtures("no_report")
def test_learned_toml_goes_back_in(curvy_run, tmp_path):
    first, second = tmp_path / "first", tmp_path / "second"
    assert invoke(curvy_run, "--out", first, "--terrain", "sand").exit_code == 0
    answer = invoke(curvy_run, "--out", second, "--parameters", first / "learned.toml")
    assert answer.exit_code == 0, answer.output
    assert content_of(second)["initial_terrain"] == "sand"
    assert str(second / "learned.toml") in answer.output


@pytest.mark.usefixtures("no_report")
def test_names_that_another_camera_may_have_are_unknown_unless_it_is_the_same(
    across_run, classifier, tmp_path
):
    unsure = copy(classifier)
    unsure.noticed_share_ = 0.4
    unsure.confidence_ = AnswerConfidence(np.zeros(4))  # right with 0.5, whatever is seen
    unsure.save(tmp_path / "a.model")
    labels = {}
    for option in ([], ["--same-camera"]):
        out = tmp_path / f"out {len(option)}"
        answer = invoke(across_run, "--out", out, "--model", tmp_path / "a.model", *option)
        assert answer.exit_code == 0, answer.output
        assert ("images of another camera may pass" in answer.output) is (option == [])
        assert content_of(out)["config"]["classifier"]["same_camera"] is bool(option)
        with (out / "terrain.csv").open() as stream:
            labels[bool(option)] = {row["label"] for row in csv.DictReader(stream)}
    assert labels[False] <= {"", "unknown"}
    assert labels[True] & {"gravel", "boards"}


@pytest.mark.usefixtures("no_report")
def test_settings_come_from_the_file_and_the_options(astride_run, model_file, tmp_path):
    config = tmp_path / "config.toml"
    config.write_text("[region]\nmost_ahead_lengths = 5.0\n[switch]\nlabels_in_row = 4\n")
    out = tmp_path / "out"
    arguments = ["--config", config, "--per-tread", "--detect-jumps", "--model", model_file]
    arguments.append("--own-statistics")
    answer = invoke(astride_run, "--out", out, *arguments)
    assert answer.exit_code == 0, answer.output
    settings = content_of(out)["config"]
    assert settings["region"]["most_ahead_lengths"] == 5.0
    assert settings["region"]["per_tread"] is True
    assert settings["switch"]["labels_in_row"] == 4
    assert settings["filter"]["detect_jumps"] is True
    assert settings["classifier"]["own_statistics"] is True
    assert "standardised by the images' own statistics" in answer.output
    with (out / "terrain.csv").open() as stream:
        assert {"left", "right"} <= set(next(csv.reader(stream)))


@pytest.mark.usefixtures("no_report")
def test_without_a_reference_it_says_so_and_offers_nothing_to_learn(tmp_path, world):
    folder = world.drive_curves(tmp_path / "run", pose=False)
    answer = invoke(folder, "--out", tmp_path / "out")
    assert answer.exit_code == 0, answer.output
    assert "no pose.csv or truth.csv" in answer.output
    assert "learned.toml" not in answer.output


@pytest.mark.parametrize(
    ("arguments", "message"),
    [
        (["--config", "odometry.csv"], "cannot be read as TOML"),
        (["--parameters", "run.toml"], "unknown table"),
        (["--model", "odometry.csv"], r"odometry\.csv"),
        (["--terrain", "unknown"], "reserved"),
    ],
)
def test_a_wrong_input_is_a_known_error_before_anything_is_written(
    across_run, tmp_path, arguments, message
):
    files = [across_run / a if "." in a else a for a in arguments]
    out = tmp_path / "out"
    answer = invoke(across_run, "--out", out, *files)
    assert isinstance(answer.exception, OdometryError)
    with pytest.raises(OdometryError, match=message):
        raise answer.exception
    assert not out.exists()


@pytest.mark.usefixtures("no_report")
def test_after_a_jump_of_the_poses_what_was_learned_is_not_recommended(world, tmp_path):
    """From half-way on the reference is 2 m aside: the filter starts anew and says so."""
    folder = world.drive_curves(tmp_path / "run")
    header, *rows = (folder / "pose.csv").read_text().split()
    lines = [header]
    for row in rows:
        t, x, y, yaw = (float(cell) for cell in row.split(","))
        lines.append(f"{t},{x},{y + 2 * (t > 6)},{yaw}")
    (folder / "pose.csv").write_text("\n".join(lines) + "\n")
    answer = invoke(folder, "--out", tmp_path / "out")
    assert answer.exit_code == 0, answer.output
    events = content_of(tmp_path / "out")["filter"]["events"]
    assert [event["kind"] for event in events] == ["reinitialised"]
    assert "Note: " in answer.output
    assert "it started again there" in answer.output
    assert "learned.toml is not recommended: " in answer.output


@pytest.mark.parametrize(
    ("options", "words"),
    [
        (["--per-tread"], "per_tread = False, found True"),
        (["--detect-jumps"], "detect_jumps = False, found True"),
        (["--own-statistics"], "own_statistics = False, found True"),
        (["--source", "none"], "from the camera"),
    ],
)
def test_an_option_that_contradicts_the_preset_is_an_error(across_run, tmp_path, options, words):
    answer = invoke(across_run, "--out", tmp_path / "out", "--preset", "chen2023", *options)
    assert isinstance(answer.exception, OdometryError)
    assert words in str(answer.exception)
    assert not (tmp_path / "out").exists()
