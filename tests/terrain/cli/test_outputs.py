"""Where the commands may write: what they refuse, and what they say of what made a result."""

import hashlib
import json
import os
import shlex
from importlib.metadata import version

import pytest
from click.testing import CliRunner

from odometry.errors import OdometryError
from odometry.installed import shipped_data
from odometry.outputs.manifest import Manifest, read_manifest
from odometry.parameters import read_parameters
from terrain.cli.outputs import asked
from terrain.cli.verbs.camera import camera
from terrain.cli.verbs.evaluate import evaluate
from terrain.cli.verbs.identify import identify
from terrain.cli.verbs.run import run
from terrain.cli.verbs.train import train


def invoke(verb, *arguments):
    return CliRunner().invoke(verb, [str(argument) for argument in arguments])


def refused(verb, *arguments):
    """The message of a command that must not do any work."""
    answer = invoke(verb, *arguments)
    assert isinstance(answer.exception, OdometryError), answer.output
    return str(answer.exception)


def contents(folder):
    return {path: path.read_bytes() for path in folder.rglob("*") if path.is_file()}


@pytest.fixture
def own_run(tmp_path, world):
    return world.drive_curves(tmp_path / "my_run")


@pytest.mark.parametrize("name", ["run.toml", "../link.toml", "truth.toml"])
def test_identify_does_not_write_over_a_file_of_its_run(own_run, tmp_path, name):
    (tmp_path / "link.toml").symlink_to(own_run / "run.toml")
    (own_run / "truth.toml").write_text("x = 3\n")
    before = contents(own_run)
    refused(identify, own_run, "--model", "icr", "--out", own_run / name)
    assert contents(own_run) == before


def test_identify_does_not_write_over_the_set_that_it_reads(own_run, tmp_path):
    file = tmp_path / "set.toml"
    assert invoke(identify, own_run, "--model", "icr", "--out", file).exit_code == 0
    before = file.read_bytes()
    assert "is the input" in refused(identify, own_run, "--model", file, "--out", file)
    assert invoke(identify, own_run, "--model", "icr", "--out", file).exit_code == 0
    assert file.read_bytes() == before


def test_train_does_not_write_over_a_photograph(tmp_path):
    photo = tmp_path / "photo.jpg"
    photo.write_bytes(b"a photograph")
    assert "is there already" in refused(train, shipped_data() / "patches", "--out", photo)
    assert photo.read_bytes() == b"a photograph"


@pytest.mark.parametrize("name", ["my_run", "my_run/images", ".", "link", "link/images", "thesis"])
def test_run_does_not_write_into_a_folder_that_is_not_its_own(tmp_path, across_run, name):
    (tmp_path / "my_run").mkdir()
    for file in across_run.glob("*.*"):
        (tmp_path / "my_run" / file.name).write_bytes(file.read_bytes())
    (tmp_path / "my_run" / "images").symlink_to(across_run / "images")
    (tmp_path / "link").symlink_to(tmp_path / "my_run")
    (tmp_path / "thesis").mkdir()
    (tmp_path / "thesis" / "thesis.tex").write_text("years of work")
    before = contents(tmp_path)
    refused(run, tmp_path / "my_run", "--out", tmp_path / name)
    assert contents(tmp_path) == before


@pytest.mark.usefixtures("no_report")
def test_run_does_not_write_over_the_parameters_that_it_reads(own_run, tmp_path):
    out = tmp_path / "out"
    assert invoke(run, own_run, "--out", out).exit_code == 0
    message = refused(run, own_run, "--parameters", out / "learned.toml", "--out", out)
    assert "is or holds the input" in message


@pytest.mark.usefixtures("no_report")
def test_a_new_folder_in_the_run_folder_is_allowed(own_run):
    before = contents(own_run)
    assert invoke(run, own_run, "--out", own_run / "results").exit_code == 0
    assert before.items() <= contents(own_run).items()


def test_a_rerun_is_byte_identical_and_one_elsewhere_too(own_run, tmp_path):
    for name in ("a", "b", "a"):
        assert invoke(run, own_run, "--out", tmp_path / name).exit_code == 0
    a, b = (
        {p.relative_to(tmp_path / n): d for p, d in contents(tmp_path / n).items()} for n in "ab"
    )
    assert a == b


@pytest.mark.usefixtures("no_report")
def test_a_result_names_what_made_it(own_run, tmp_path, monkeypatch):
    monkeypatch.chdir(own_run.parent)
    assert invoke(identify, "my_run", "--model", "icr", "--out", "set.toml").exit_code == 0
    options = ["--terrain", "a b", "--parameters", "set.toml", "--no-vision"]
    assert invoke(run, "my_run", "--out", "out", *options).exit_code == 0
    made = json.loads((tmp_path / "out" / "result.json").read_text())["made"]
    assert made["command"] == (
        "terrain-odometry run my_run --parameters set.toml --no-vision --terrain 'a b'"
    )
    sums = {one["role"]: (one["path"], one["sha256"]) for one in made["inputs"]}
    assert set(sums) == {"RUN", "--parameters"}
    of_set = hashlib.sha256((tmp_path / "set.toml").read_bytes()).hexdigest()
    assert sums["--parameters"] == ("set.toml", of_set)
    assert made["packages"]["numpy"] == version("numpy")
    assert made["packages"]["terrain-odometry"] == version("terrain-odometry")
    assert read_manifest(tmp_path / "out").made == made
    comment = (tmp_path / "set.toml").read_text().split("[")[0]
    assert "# command: terrain-odometry identify my_run --model icr\n" in comment
    assert sums["RUN"][1] in comment
    assert read_parameters("set.toml").terrains


@pytest.mark.usefixtures("no_report")
def test_another_input_or_setting_is_another_identity(own_run, tmp_path, world):
    other = world.drive_curves(tmp_path / "other", truth=True)
    identities = []
    for number, arguments in enumerate(([own_run], [other], [own_run, "--from", "1"])):
        out = tmp_path / str(number)
        assert invoke(run, *arguments, "--out", out).exit_code == 0
        identities.append(json.loads((out / "result.json").read_text())["made"]["identity"])
    assert len(set(identities)) == 3


@pytest.mark.usefixtures("no_report")
@pytest.mark.parametrize(
    "options",
    [
        ["--mount", *("0.1", "0.0", "0.5", "0.0", "0.7", "-0.1"), "--write"],
        ["--chessboard", "9x6", "--square-m", "0.03"],
        ["--transforms", "frames.yaml", "--frame", "front camera"],
    ],
)
def test_the_command_that_is_kept_is_read_as_the_one_that_was_given(own_run, tmp_path, options):
    (tmp_path / "frames.yaml").touch()
    given = [str(tmp_path / word) if word == "frames.yaml" else word for word in options]
    first = camera.make_context("camera", [str(own_run), "--out", "out", *given])
    kept = shlex.split(asked(first).command)
    assert kept[:2] == ["terrain-odometry", "camera"]
    again = camera.make_context("camera", [*kept[2:], "--out", "out"])
    assert again.params == first.params


def test_no_command_reads_what_was_not_finished(own_run, tmp_path):
    out = tmp_path / "out"
    assert invoke(run, own_run, "--out", out).exit_code == 0
    done = read_manifest(out)
    Manifest(done.verb, "unfinished", done.files).write(out)
    answer = invoke(evaluate, out)
    assert answer.exit_code == 1
    assert "unfinished: `terrain-odometry run` was stopped" in answer.output
    message = refused(run, own_run, "--parameters", out / "learned.toml", "--out", tmp_path / "b")
    assert "unfinished" in message
    assert invoke(run, own_run, "--out", out).exit_code == 0
    assert invoke(evaluate, out).exit_code == 0


def test_a_folder_that_may_not_be_read_is_no_traceback(own_run, tmp_path):
    (tmp_path / "fifo.toml").parent.mkdir(exist_ok=True)
    os.mkfifo(tmp_path / "fifo.toml")
    assert "is there already" in refused(
        identify, own_run, "--model", "icr", "--out", tmp_path / "fifo.toml"
    )
