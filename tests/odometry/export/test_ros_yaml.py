"""ros.yaml, read by a YAML parser: the numbers, their types, and what stands beside them."""

from dataclasses import replace

import numpy as np
import pytest

from odometry.errors import ParameterError
from odometry.export import ros_file
from odometry.export.drive_numbers import MotionErrors, Pace, drive_numbers
from odometry.export.ros_yaml import ros_yaml
from odometry.export.source import read_export_source
from odometry.models.catalogue import MODELS
from odometry.parameters import ParameterSet, TerrainParameters, write_parameters
from odometry.recording.run import Robot
from tests.odometry.export.result_folder import TABLE, YAW_RATE_RAD_S, write_results

ruamel = pytest.importorskip("ruamel.yaml")
ERRORS, PACE = MotionErrors(0.02, 0.01, 5.0, "of a test"), Pace(1.0, 0.5)


def parsed(text):
    return ruamel.YAML(typ="safe").load(text)


def numbers_in(node):
    if isinstance(node, dict | list):
        for each in node.values() if isinstance(node, dict) else node:
            yield from numbers_in(each)
    elif not isinstance(node, str | bool):
        yield node


@pytest.fixture
def sand():
    return drive_numbers("sand", TABLE, 0.6)


def test_each_node_gets_its_numbers(sand):
    content = parsed(ros_yaml(sand, [sand], errors=ERRORS, pace=PACE, wheel_radius_m=0.1))
    controller = content["diff_drive_controller"]["ros__parameters"]
    assert controller["wheel_separation"] == 0.6
    assert controller["wheel_radius"] == 0.1
    assert controller["wheel_separation_multiplier"] == 1.5
    assert controller["left_wheel_radius_multiplier"] == 0.9
    assert controller["right_wheel_radius_multiplier"] == 0.95
    expected = ERRORS.twist_variances(PACE, (0.05, 0.1))
    diagonal = np.array(controller["twist_covariance_diagonal"])
    np.testing.assert_allclose(diagonal[[0, 1, 5]], expected, rtol=1e-5)
    assert diagonal[2:5].tolist() == [1e6] * 3
    noise = content["ekf_filter_node"]["ros__parameters"]["process_noise_covariance"]
    assert len(noise) == 225
    matrix = np.reshape(noise, (15, 15))
    grown = ERRORS.pose_variances_per_s(PACE)
    np.testing.assert_allclose(np.diag(matrix)[[0, 1, 5]], grown, rtol=1e-5)
    assert np.count_nonzero(matrix) == np.count_nonzero(np.diag(matrix)) == 15
    slip = content["slip_by_terrain"]["ros__parameters"]["sand"]
    assert slip["slip_left"] == pytest.approx(0.1)
    assert slip["turning_slip"] == pytest.approx(1 - 0.925 / 1.5, rel=1e-5)


def test_every_number_is_a_float(sand):
    """ROS 2 refuses an integer for a double; 1 and 1e-05 would be no floats."""
    odd = replace(sand, track_width_m=1.0, left=replace(sand.left, value=1e-5, low=0, high=2e-5))
    found = list(numbers_in(parsed(ros_yaml(odd, [odd], errors=ERRORS, pace=PACE))))
    assert len(found) > 230
    assert {type(number) for number in found} == {float}


def test_the_interval_stands_behind_each_number(sand):
    lines = ros_yaml(sand, [sand]).splitlines()
    half = 1.96 * np.hypot(0.02, 0.03) / 0.6
    (line,) = [each for each in lines if each.startswith("    wheel_separation_multiplier")]
    assert line.endswith(f"# {1.5 - half:.4g} to {1.5 + half:.4g}")
    (slip,) = [each for each in lines if "slip_left:" in each]
    assert slip.endswith(f"# {0.1 - 1.96 * 0.005:.4g} to {0.1 + 1.96 * 0.005:.4g}")


def test_what_cannot_be_expressed_is_said(sand):
    text = ros_yaml(sand, [sand])
    assert "#   x_icr = 0.1 m, 0.0804 to 0.1196" in text
    assert "--x -0.1 --y -0.05 --frame-id icr_link" in text
    assert "twist_covariance_diagonal is left out" in text
    assert "ekf_filter_node is left out" in text
    assert set(parsed(text)) == {"diff_drive_controller", "slip_by_terrain"}


def test_a_symmetric_model_has_nothing_left_over():
    table = TerrainParameters("icr_symmetric", {"alpha": 0.9, "b_hat": 1.1})
    symmetric = drive_numbers("sand", table, 0.6)
    text = ros_yaml(symmetric, [symmetric])
    assert "supposes x_icr = 0" in text
    assert "icr_link" not in text
    assert "# not identified" in text


@pytest.mark.parametrize("name", ['a "b": [c', "tab\tand\nline", "ä#: x", "\\", "on"])
def test_any_name_of_a_terrain_stays_a_key(sand, name):
    named = replace(sand, terrain=name, effects=(name,))
    keys = parsed(ros_yaml(named, [named]))["slip_by_terrain"]["ros__parameters"]
    assert list(keys) == ["".join(c if c.isprintable() else "?" for c in name)]


def test_a_result_gives_its_pace_and_errors(tmp_path):
    source = read_export_source(write_results(tmp_path / "results"))
    ros_file.write(source, tmp_path)
    text = (tmp_path / "ros.yaml").read_text()
    assert "odometer_without_gyroscope over 5 m of the run bend, against truth" in text
    assert source.pace.wheel_speed_m_s == pytest.approx(1.0)
    assert source.pace.yaw_rate_rad_s == pytest.approx(YAW_RATE_RAD_S)
    errors = MotionErrors.of_means(0.05, np.radians(2.0), 5.0, "")
    diagonal = parsed(text)["diff_drive_controller"]["ros__parameters"]["twist_covariance_diagonal"]
    expected = errors.twist_variances(source.pace, (0.05, 0.1))
    np.testing.assert_allclose(np.array(diagonal)[[0, 1, 5]], expected, rtol=1e-5)


def test_any_name_of_what_is_left_out_stays_a_comment(tmp_path):
    file, model = tmp_path / "set.toml", MODELS["full_linear"]
    ice = TerrainParameters(model.name, model.guess(Robot(0.6)))
    terrains = {"sand": TABLE, "ice\nfield: 1": ice}
    write_parameters(file, ParameterSet(terrains, {"track_width": 0.6}))
    ros_file.write(read_export_source(file, terrain="sand"), tmp_path)
    content = parsed((tmp_path / "ros.yaml").read_text())
    assert set(content) == {"diff_drive_controller", "slip_by_terrain"}


def test_a_controller_knows_one_terrain(tmp_path):
    file = tmp_path / "set.toml"
    write_parameters(file, ParameterSet({"sand": TABLE, "clay": TABLE}, {"track_width": 0.6}))
    with pytest.raises(ParameterError, match=r"--terrain among sand, clay"):
        ros_file.write(read_export_source(file), tmp_path)
    with pytest.raises(ParameterError, match=r"no terrain 'mud': it has sand, clay"):
        ros_file.write(read_export_source(file, terrain="mud"), tmp_path)
    ros_file.write(read_export_source(file, terrain="clay"), tmp_path)
    content = parsed((tmp_path / "ros.yaml").read_text())
    assert list(content["slip_by_terrain"]["ros__parameters"]) == ["sand", "clay"]
    assert content["diff_drive_controller"]["ros__parameters"]["wheel_separation"] == 0.6
