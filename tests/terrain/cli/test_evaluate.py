"""`evaluate`: finished runs side by side, and folders that are none."""

import json

import pytest
from click.testing import CliRunner

from terrain.cli.verbs.evaluate import evaluate


@pytest.fixture
def results(tmp_path):
    """Folders with a result.json of known numbers."""

    def make(name, content):
        folder = tmp_path / name
        folder.mkdir()
        text = content if isinstance(content, str) else json.dumps(content)
        (folder / "result.json").write_text(text)
        return str(folder)

    return make


def finished(mean, final=0.5):
    errors = {
        "windows": 3,
        "translation_m_per_m": {"mean": mean, "quartiles": [0.01, 0.02, 0.03]},
        "rotation_deg_per_m": {"mean": 1.5, "quartiles": None},
        "position_m": {"mean": 0.25, "final": final},
    }
    return {"reference": "pose", "horizon_m": 5.0, "errors": {"odometer": errors}}


def test_a_row_for_each_trajectory_of_each_run(results):
    with_vision = results("with", finished(0.0123))
    without = results("without", finished(None, None))
    answer = CliRunner().invoke(evaluate, [with_vision, without])
    assert answer.exit_code == 0
    lines = answer.output.splitlines()
    numbers = ["0.0123", "0.0200", "1.5000", "-", "0.2500", "-", "0.5000"]
    assert lines[1].split() == [with_vision, "-", "odometer", "pose", *numbers]
    assert lines[2].split() == [without, "-", "odometer", "pose", "-", *numbers[1:6], "-"]


def of_run(path, mean):
    made = {"inputs": [{"role": "--model", "path": "m"}, {"role": "RUN", "path": path}]}
    return finished(mean) | {"run": path.rsplit("/", 1)[-1], "made": made}


def test_a_row_names_its_run_and_where_names_are_alike_its_place(results):
    folders = [
        results("one", of_run("monday/drive", 0.01)),
        results("two", of_run("tuesday/drive", 0.02)),
        results("three", of_run("tuesday/turns", 0.03)),
    ]
    answer = CliRunner().invoke(evaluate, folders)
    runs = [line.split()[1] for line in answer.output.splitlines()[1:4]]
    assert runs == ["monday/drive", "tuesday/drive", "turns"]
    twice = CliRunner().invoke(evaluate, [folders[0], results("again", of_run("monday/drive", 1))])
    assert [line.split()[1] for line in twice.output.splitlines()[1:3]] == ["drive", "drive"]
    written = json.loads(CliRunner().invoke(evaluate, [folders[0], "--json"]).output)
    assert written[folders[0]]["run"] == "drive"


def test_a_row_says_what_it_is_against(results):
    content = finished(0.0123)
    estimate = {"against": "withheld pose"} | content["errors"]["odometer"]
    content["errors"] |= {"estimate": estimate}
    answer = CliRunner().invoke(evaluate, [results("a", content)])
    lines = answer.output.splitlines()
    assert " pose " in lines[1]
    assert "withheld pose" in lines[2]


def test_a_run_without_a_reference_says_so(results):
    folder = results("blind", {"reference": None, "horizon_m": 5.0, "errors": {}})
    answer = CliRunner().invoke(evaluate, [folder])
    assert answer.exit_code == 0
    assert "nothing to compare with" in answer.output


@pytest.mark.parametrize(
    "content",
    [
        "{",
        "[1, 2]",
        "3",
        {"reference": "pose"},
        {"errors": None},
        {"errors": {"odometer": {}}},
        {"errors": {"odometer": 3}},
        {"errors": [1]},
        finished("much"),
    ],
)
def test_a_failed_folder_is_a_row_and_the_exit_code_1(results, content):
    good, bad = results("good", finished(0.0123)), results("bad", content)
    answer = CliRunner().invoke(evaluate, [bad, good])
    assert isinstance(answer.exception, SystemExit)
    assert answer.exit_code == 1
    assert "0.0123" in answer.output
    (row,) = [line for line in answer.output.splitlines() if line.split()[0] == bad]
    assert "failed: " in row
    assert "result.json" in row


def test_a_missing_folder_is_a_row(tmp_path, results):
    answer = CliRunner().invoke(
        evaluate, [str(tmp_path / "absent"), results("good", finished(1.0))]
    )
    assert answer.exit_code == 1
    assert "no result.json; expected a folder that `run` wrote" in answer.output
    assert "1.0000" in answer.output


def test_json_gives_the_numbers_and_the_failures(tmp_path, results):
    good, absent = results("good", finished(0.0123)), str(tmp_path / "absent")
    answer = CliRunner().invoke(evaluate, ["--json", good, absent])
    assert answer.exit_code == 1
    content = json.loads(answer.output)
    assert content[good] == finished(0.0123) | {
        "run": None,
        "run_path": None,
        "other_odometry": [],
        "remarks": [],
    }
    assert set(content[absent]) == {"error"}


def test_no_folder_is_a_usage_error():
    assert CliRunner().invoke(evaluate, []).exit_code == 2


def test_what_the_run_remarked_beside_its_errors_is_said(results):
    folder = results("one", finished(0.3) | {"remarks": ["The poses themselves are off."]})
    answer = CliRunner().invoke(evaluate, [folder])
    assert f"Note: {folder}: The poses themselves are off." in answer.stderr
