"""One parameter set with effects through `run`, `compare` and `identify`."""

import csv
import json

import numpy as np
import pytest
from click.testing import CliRunner

from odometry.errors import ParameterError
from odometry.parameters import read_parameters
from terrain.cli.verbs.compare import compare
from terrain.cli.verbs.identify import identify
from terrain.cli.verbs.run import run

ARM = (0.25, -0.1)
TRUE = """
[terrain.ground]
y_left = 0.26
y_right = -0.24
x_icr = 0.03
"""
WITH_EFFECTS = (
    TRUE.replace("x_icr = 0.03", "x_icr = -0.07")
    + f"""
[[terrain.ground.effects]]
name = "wheel_scale"
form = "factors"
parameters = {{ c_l = 0.8, c_r = 1.25 }}
[[terrain.ground.effects]]
name = "lateral_skid"
form = "x_icr"
source = "a guess"
parameters = {{ x_shift = 0.1 }}
[[terrain.ground.effects]]
name = "lever_arm"
form = "constant"
parameters = {{ x_arm = {ARM[0]}, y_arm = {ARM[1]} }}
"""
)


def rewrite(file, **changes):
    """Replace columns of a CSV file by functions of all of them."""
    with file.open(newline="") as stream:
        header, *rows = list(csv.reader(stream))
    columns = dict(zip(header, np.array(rows, float).T, strict=True))
    changed = columns | {name: of(columns) for name, of in changes.items()}
    lines = [",".join(map(repr, row)) for row in np.stack(list(changed.values()), 1).tolist()]
    file.write_text("\n".join([",".join(header), *lines]) + "\n")


@pytest.fixture
def folder(world, tmp_path):
    """A winding drive: its wheels are not as stated, its sensor is ahead and to the right."""
    folder = world.drive_curves(tmp_path / "curves", truth=True)
    rewrite(
        folder / "odometry.csv",
        v_left=lambda c: c["v_left"] / 0.8,
        v_right=lambda c: c["v_right"] / 1.25,
    )
    rewrite(
        folder / "pose.csv",
        x=lambda c: c["x"] + ARM[0] * np.cos(c["yaw"]) - ARM[1] * np.sin(c["yaw"]),
        y=lambda c: c["y"] + ARM[0] * np.sin(c["yaw"]) + ARM[1] * np.cos(c["yaw"]),
    )
    return folder


@pytest.fixture
def files(tmp_path):
    for name, text in (("true", TRUE), ("extended", WITH_EFFECTS)):
        (tmp_path / f"{name}.toml").write_text(text)
    return tmp_path / "true.toml", tmp_path / "extended.toml"


def invoke(command, *arguments):
    answer = CliRunner().invoke(command, list(map(str, arguments)))
    if answer.exception is not None and not isinstance(answer.exception, SystemExit):
        raise answer.exception
    return answer


@pytest.mark.usefixtures("no_report")
def test_run_writes_where_the_robot_was(folder, files, tmp_path):
    """Against the truth the odometer of the extended set is exact, that of the plain one is not."""
    errors = {}
    for file in files:
        out = tmp_path / f"{file.stem}_out"
        answer = invoke(run, folder, "--parameters", file, "--out", out)
        assert answer.exit_code == 0, answer.output
        content = json.loads((out / "result.json").read_text())
        assert content["reference"] == "truth"
        errors[file.stem] = content["errors"]
        if file.stem == "extended":
            names = ["wheel_scale", "lateral_skid", "lever_arm"]
            assert content["effects"] == {"ground": names}
            assert f"Effects on ground, in every trajectory but the ideal: {', '.join(names)}" in (
                answer.output
            )
            learned = read_parameters(out / "learned.toml").terrains["ground"]
            assert [effect["name"] for effect in learned.effects] == names
        else:
            assert content["effects"] == {}
    found, plain = errors["extended"], errors["true"]
    assert found["odometer"]["position_m"]["mean"] < 1e-4
    assert found["estimate"]["position_m"]["mean"] < 0.01
    assert plain["odometer"]["position_m"]["mean"] > 0.5
    assert plain["estimate"]["position_m"]["mean"] > 0.1
    ideal = "differential_drive"
    assert found[ideal]["rotation_deg_per_m"] == plain[ideal]["rotation_deg_per_m"]


def test_compare_judges_by_what_the_sensor_sees(folder, files, tmp_path):
    out = tmp_path / "out"
    models = [option for file in files for option in ("--model", file)]
    options = ["--evaluation-horizon", "0.5", "--horizon", "0.5"]
    answer = invoke(compare, folder, *models, *options, "--out", out)
    assert answer.exit_code == 0, answer.output
    (place,) = json.loads((out / "comparison.json").read_text())["places"]
    errors = {model["model"]: model["translation_m_per_m"]["mean"] for model in place["models"]}
    assert errors["extended"] < 1e-4
    assert errors["true"] > 0.1


@pytest.mark.usefixtures("no_report")
def test_identify_holds_the_effects_and_finds_the_rest(folder, files, tmp_path):
    """With the skid held, x_icr is what is left of the true one."""
    out = tmp_path / "found.toml"
    options = ["--horizon", "0.5", "--starts", "1", "--out", out]
    answer = invoke(identify, folder, "--model", files[1], *options)
    assert answer.exit_code == 0, answer.output
    found = read_parameters(out).terrains["ground"]
    expected = {"y_left": 0.26, "y_right": -0.24, "x_icr": -0.07}
    assert found.values == pytest.approx(
        expected | {"alpha_left": 1.0, "alpha_right": 1.0}, abs=1e-3
    )
    asked = read_parameters(files[1]).terrains["ground"].effects
    assert [e["parameters"] for e in found.effects] == [e["parameters"] for e in asked]
    assert "held: lever_arm (constant): x_arm = 0.25, y_arm = -0.1" in answer.output
    assert "These parameters are not recommended: check warns of" in answer.output  # of the arm
    again = invoke(run, folder, "--parameters", out, "--out", tmp_path / "again")
    assert again.exit_code == 0, again.output


@pytest.mark.usefixtures("no_report")
def test_identify_says_of_which_robot_a_set_is(folder, files, tmp_path):
    files[0].write_text('[vehicle]\nname = "wide"\ntrack_width = 3.0\n' + TRUE)
    options = ["--horizon", "0.5", "--starts", "1", "--out", tmp_path / "found.toml"]
    answer = invoke(identify, folder, "--model", files[0], *options)
    assert answer.exit_code == 0, answer.output
    assert "Note: the parameter set is of a robot of track width 3 m (wide)" in answer.output


def test_an_unknown_effect_is_a_known_error_of_all_three(folder, tmp_path):
    wrong = tmp_path / "wrong.toml"
    wrong.write_text(WITH_EFFECTS.replace('"lever_arm"', '"long_arm"'))
    words = r"terrain\.ground\]: effects\[2\]: effect long_arm/constant, expected one of"
    with pytest.raises(ParameterError, match=words):
        invoke(run, folder, "--parameters", wrong, "--out", tmp_path / "out")
    with pytest.raises(ParameterError, match=words):
        invoke(identify, folder, "--model", wrong, "--out", tmp_path / "out.toml")
    models = ["--model", wrong, "--model", "differential_drive"]
    answer = invoke(compare, folder, *models, "--out", tmp_path / "out")
    assert "effect long_arm/constant" in answer.output
