"""`export` and `identify --ros`, as a user calls them."""

import importlib
import re

import pytest
from click.testing import CliRunner

from odometry.io.trajectory_files import FORMATS as TRAJECTORY_FORMATS
from odometry.outputs.own_names import has_own_name
from terrain.cli.verbs.export import FORMATS, export
from terrain.cli.verbs.identify import identify
from terrain.results import write_results

SET = """[vehicle]
track_width = 0.5
[terrain.sand]
y_left = 0.5
y_right = -0.5
x_icr = 0.0
[terrain.sand.sigma]
y_left = 0.01
y_right = 0.01
"""


@pytest.fixture
def parameters(tmp_path):
    file = tmp_path / "set.toml"
    file.write_text(SET)
    return file


@pytest.fixture(scope="module")
def finished(across_result, tmp_path_factory):
    """A result with images and learned parameters."""
    out = tmp_path_factory.mktemp("finished") / "results"
    write_results(across_result, out)
    (out / "learned.toml").write_text(SET)
    return out


def call(*arguments):
    return CliRunner().invoke(export, [str(each) for each in arguments])


def to(names):
    return [word for name in names for word in ("--to", name)]


def test_every_format_is_listed_and_has_a_writer():
    text = call("--help").stdout
    for name, (about, module) in FORMATS.items():
        assert re.search(rf"^ +{name} +{re.escape(about)}$", text, re.MULTILINE), name
        assert callable(importlib.import_module(f"odometry.export.{module}").write)
    assert set(TRAJECTORY_FORMATS) <= set(FORMATS)


def test_every_format_of_a_result_with_its_own_names(finished, tmp_path):
    out = tmp_path / "out"
    answer = call(finished, *to(FORMATS), "--out", out)
    assert answer.exit_code == 0, answer.output
    written = {file.name for file in out.iterdir()} - {"terrain-odometry.json"}
    assert {"ros.yaml", "results.mcap", "terrain_cells.csv", "odometer.parquet"} <= written
    assert all(has_own_name("export", name) for name in written), written
    assert call(finished, "--to", "tum", "--out", out).exit_code == 0
    left = {file.name for file in out.iterdir()}
    assert left == {"odometer.tum", "estimate.tum", "terrain-odometry.json"}


def test_a_set_gives_ros_alone(parameters, tmp_path):
    answer = call(parameters, "--to", "ros", "--out", tmp_path / "out")
    assert answer.exit_code == 0, answer.output
    text = (tmp_path / "out" / "ros.yaml").read_text()
    assert text.startswith("# terrain-odometry ROS parameters, format 1\n# made by: ")
    assert "wheel_separation_multiplier: 2.0  # 1.945 to 2.055" in text
    for name in set(FORMATS) - {"ros"}:
        refused = call(parameters, "--to", name, "--out", tmp_path / name)
        assert "expected a folder that `run` wrote" in str(refused.exception), name
        assert not (tmp_path / name).exists()


def test_the_track_width_that_is_given_counts(parameters, tmp_path):
    call(parameters, "--to", "ros", "--track-width", "0.8", "--out", tmp_path / "out")
    assert "multiplier: 1.25 " in (tmp_path / "out" / "ros.yaml").read_text()


def test_a_set_in_millimetres_is_said_there_and_in_the_file(parameters, tmp_path):
    parameters.write_text(
        SET.replace("0.5\nx_icr", "500.0\nx_icr").replace("= 0.5\ny_r", "= 500.0\ny_r")
    )
    answer = call(parameters, "--to", "ros", "--out", tmp_path / "out")
    (note,) = [line for line in answer.stderr.splitlines() if line.startswith("Warning: ")]
    assert "as if 1000 m wide, 2000 of its track widths" in note
    assert f"# {note.removeprefix('Warning: ')}\n" in (tmp_path / "out" / "ros.yaml").read_text()


def test_a_name_with_a_line_break_is_one_line_of_comment(parameters, tmp_path):
    named = '[vehicle]\nname = "rover\\nsecond: line"\n'
    parameters.write_text(SET.replace("[vehicle]\n", named))
    call(parameters, "--to", "ros", "--track-width", "0.8", "--out", tmp_path / "out")
    assert "\nsecond" not in (tmp_path / "out" / "ros.yaml").read_text()


def test_what_was_made_from_is_in_the_manifest(finished, tmp_path):
    """The sum is of the result, not of its figures."""
    call(finished, "--to", "tum", "--out", tmp_path / "out")
    first = (tmp_path / "out" / "terrain-odometry.json").read_text()
    table = finished / "estimate.csv"
    before = table.read_text()
    table.write_text(before.replace("t,x", "t,x", 1) + "\n")
    call(finished, "--to", "tum", "--out", tmp_path / "out")
    table.write_text(before)
    assert (tmp_path / "out" / "terrain-odometry.json").read_text() != first


def test_identify_writes_ros_and_replaces_its_own(tmp_path, world):
    """The multiplier times the track width is the distance of the ICRs that the set states."""
    world.drive_curves(tmp_path / "run")
    arguments = [tmp_path / "run", "--model", "icr", "--out", tmp_path / "set.toml", "--starts", 1]
    arguments = [*map(str, arguments), "--horizon", "0.5", "--ros", str(tmp_path / "ros.yaml")]
    for _ in range(2):
        answer = CliRunner().invoke(identify, arguments)
        assert answer.exit_code == 0, answer.output
    text = (tmp_path / "ros.yaml").read_text()
    told = call(tmp_path / "set.toml", "--to", "ros", "--out", tmp_path / "out")
    assert told.exit_code == 0, told.output
    again = (tmp_path / "out" / "ros.yaml").read_text()
    named = r"^    \w+_multiplier: .*$"
    assert re.findall(named, text, re.M) == re.findall(named, again, re.M)
    assert len(re.findall(named, text, re.M)) == 3
    assert "from held-out errors over 0.5" in text
    assert "twist_covariance_diagonal: [" in text
    (tmp_path / "ros.yaml").write_text("mine: 1\n")
    assert CliRunner().invoke(identify, arguments).exit_code == 1
    assert (tmp_path / "ros.yaml").read_text() == "mine: 1\n"


def test_identify_refuses_ros_of_a_model_without_multipliers(tmp_path):
    arguments = [str(tmp_path), "--model", "full_linear", "--out", "set.toml", "--ros", "a.yaml"]
    answer = CliRunner().invoke(identify, arguments)
    assert answer.exit_code == 2
    assert "no constant ICRs" in answer.output


TWO = """[terrain.mud]
model = "full_linear"
gamma_11 = 0.5
gamma_12 = 0.5
gamma_21 = 0.0
gamma_22 = 0.0
gamma_31 = -1.0
gamma_32 = 1.0
[terrain.sand]
y_left = 0.5
y_right = -0.5
x_icr = 0.0
"""


def test_a_terrain_without_such_numbers_does_not_stop_the_one_that_is_requested(tmp_path):
    """The error of the asked one names it, not the first of the set."""
    (tmp_path / "set.toml").write_text(TWO)
    asked = (tmp_path / "set.toml", "--to", "ros", "--terrain", "sand", "--out", tmp_path / "out")
    assert "[terrain.sand]: the model 'icr' does not give" in str(call(*asked).exception)
    answer = call(*asked, "--track-width", 0.5)
    assert answer.exit_code == 0, answer.output
    text = (tmp_path / "out" / "ros.yaml").read_text()
    assert "# left out: [terrain.mud]: " in text
    assert '"sand":' in text
