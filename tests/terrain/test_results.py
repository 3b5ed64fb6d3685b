"""The output folder: every file, its columns, its numbers, and the same bytes twice."""

from dataclasses import replace
from itertools import pairwise

import numpy as np
import pytest

from odometry.io.trajectory_files import read_trajectory
from odometry.parameters import read_parameters
from terrain.main_job import run_odometry
from terrain.result.result_table import result_table
from terrain.results import write_results
from tests.terrain.output_tables import TERRAIN, columns, numbers, strict

POSE = ["t", "x", "y", "yaw"]
STATE = [*POSE, "y_left", "y_right", "x_icr", "gyro_bias", "alpha_left", "alpha_right"]


@pytest.fixture(scope="module")
def curvy_result(curvy_run):
    return run_odometry(curvy_run, terrain="sand")


@pytest.fixture(scope="module")
def curvy_out(curvy_result, tmp_path_factory):
    out = tmp_path_factory.mktemp("out") / "curvy"
    write_results(curvy_result, out)
    return out


def test_every_promised_file_is_written_and_nothing_else(across_result, curvy_result, tmp_path):
    always = {"odometer.csv", "odometer.tum", "estimate.csv", "estimate.tum", "result.json"}
    always |= {"reference.csv", "reference.tum"}
    for name, result, expected in (
        ("across", across_result, always | {"terrain.csv"}),
        ("curvy", curvy_result, always | {"learned.toml"}),
    ):
        written = write_results(result, tmp_path / name)
        assert {file.name for file in written} == expected
        assert {file.name for file in (tmp_path / name).iterdir()} == expected


def test_columns_are_those_of_the_format(across_out):
    covariances = ["covariance_x_y", "covariance_x_yaw", "covariance_y_yaw"]
    assert columns(across_out / "odometer.csv")[0] == [
        *POSE,
        *("sigma_x", "sigma_y", "sigma_yaw"),
        *covariances,
    ]
    sigmas = [f"sigma_{name}" for name in STATE[1:]]
    assert columns(across_out / "estimate.csv")[0] == STATE + sigmas
    assert columns(across_out / "terrain.csv")[0][:5] == TERRAIN


def test_the_estimates_are_those_of_the_replay(curvy_out, curvy_result):
    estimates = curvy_result.replay.estimates
    found = numbers(curvy_out / "estimate.csv", STATE)
    np.testing.assert_allclose(found[:, 0], [e.stamp_s for e in estimates], atol=1e-9)
    np.testing.assert_allclose(found[:, 1:], [e.mean for e in estimates], atol=1e-9)
    sigmas = numbers(curvy_out / "estimate.csv", [f"sigma_{name}" for name in STATE[1:]])
    variances = [np.diag(e.covariance) for e in estimates]
    np.testing.assert_allclose(sigmas, np.sqrt(variances), atol=1e-9)


def test_the_odometer_is_the_model_run_open_loop_with_the_icrs_then_held(
    curvy_out, curvy_run, world
):
    """Integrated anew, in small steps, from the two tables and the first measured pose."""
    estimate = numbers(curvy_out / "estimate.csv", STATE)
    odometry = numbers(curvy_run / "odometry.csv", ["t", "v_left", "v_right"])
    pose = numbers(curvy_run / "pose.csv", POSE)[0, 1:]
    expected = [pose]
    for row, following in pairwise(estimate):
        speeds = odometry[np.searchsorted(odometry[:, 0], row[0] + 1e-12, side="right") - 1, 1:]
        v_x, v_y, omega = world.twist(*(row[8:10] * speeds), *row[4:7])
        step_s = (following[0] - row[0]) / 20
        x, y, yaw = expected[-1]
        for _ in range(20):
            middle = yaw + omega * step_s / 2
            x += (v_x * np.cos(middle) - v_y * np.sin(middle)) * step_s
            y += (v_x * np.sin(middle) + v_y * np.cos(middle)) * step_s
            yaw += omega * step_s
        expected.append(np.array([x, y, yaw]))
    odometer = numbers(curvy_out / "odometer.csv", POSE)
    np.testing.assert_allclose(odometer[:, 0], estimate[:, 0], atol=1e-9)
    difference = odometer[:, 1:] - expected
    assert np.abs(difference[:, :2]).max() < 1e-5
    assert np.abs(np.angle(np.exp(1j * difference[:, 2]))).max() < 1e-6
    # and it is no copy of the corrected one
    assert np.abs(odometer[-1, 1:3] - estimate[-1, 1:3]).max() > 1e-3


def test_tum_holds_the_same_poses(curvy_out):
    """TUM: stamp x y z qx qy qz qw, the rotation about z."""
    for name in ("odometer", "estimate"):
        poses = numbers(curvy_out / f"{name}.csv", POSE)
        tum = np.loadtxt(curvy_out / f"{name}.tum")
        assert tum.shape[1] == 8
        np.testing.assert_allclose(tum[:, :3], poses[:, :3], atol=1e-8)
        assert not tum[:, 3:6].any()
        yaw = 2 * np.arctan2(tum[:, 6], tum[:, 7])
        np.testing.assert_allclose(np.exp(1j * yaw), np.exp(1j * poses[:, 3]), atol=1e-8)


def test_result_json_is_strict_and_names_the_switches(across_out, across_result):
    content = strict((across_out / "result.json").read_text())
    assert content["vision"] is True
    assert content["initial_terrain"] == "gravel"
    assert [switch["terrain"] for switch in content["switches"]] == ["boards", "gravel"]
    for switch in content["switches"]:
        assert switch["waited_s"] == pytest.approx(switch["stamp_s"] - switch["seen_s"])
        assert switch["waited_m"] == pytest.approx(0.5 * switch["waited_s"], abs=1e-6)
    assert sum(content["sightings"].values()) == len(across_result.watcher.image_labels)
    assert content["config"] == across_result.config.to_table()
    assert content["reference"] == "pose"


def test_the_errors_of_result_json_are_those_of_the_tables(curvy_out, curvy_run):
    """Mean and last distance between odometer.csv and pose.csv, whose stamps it shares."""
    content = strict((curvy_out / "result.json").read_text())
    pose = numbers(curvy_run / "pose.csv", POSE)
    odometer = numbers(curvy_out / "odometer.csv", POSE)
    rows = np.searchsorted(odometer[:, 0], pose[:, 0] - 1e-6)
    distances = np.hypot(*(odometer[rows, 1:3] - pose[:, 1:3]).T)
    found = content["errors"]["odometer"]["position_m"]
    assert found["mean"] == pytest.approx(distances.mean(), abs=1e-6)
    assert found["final"] == pytest.approx(distances[-1], abs=1e-6)
    assert content["errors"]["estimate"]["against"] == "withheld pose"
    assert content["withheld"] == {"poses": 30, "judged": 6, "every_s": 2.0, "silent_s": 1.0}
    assert content["gyroscope"] is False
    assert content["off_at_the_end_m"]["odometer"] == pytest.approx(distances[-1], abs=1e-6)
    assert content["filter"]["poses"] == len(pose) - 1  # the first starts the filter
    assert content["duration_s"] == pytest.approx(12.0)


def test_the_covariance_of_the_odometer_is_in_its_table_and_by_distance(curvy_out, curvy_result):
    names = ["sigma_x", "sigma_y", "sigma_yaw", "covariance_x_y", "covariance_x_yaw"]
    found = numbers(curvy_out / "odometer.csv", [*names, "covariance_y_yaw"])
    matrices = curvy_result.uncertainty.covariances
    np.testing.assert_allclose(found[:, 0] ** 2, matrices[:, 0, 0], atol=1e-8)
    np.testing.assert_allclose(found[:, 5], matrices[:, 1, 2], atol=1e-8)
    content = strict((curvy_out / "result.json").read_text())["odometer_uncertainty"]
    (after,) = content["after"]  # the drive is of 6 m
    assert after["distance_m"] == 5.0
    row = np.searchsorted(curvy_result.run.wheel_travel_m, 5.0)
    assert after["sigma_yaw_rad"] == pytest.approx(found[row, 2], rel=0.05)
    assert "too short" in content["source"]
    assert content["nees"] == []


def test_without_poses_the_estimate_is_no_surer_than_the_odometer(tmp_path, world):
    run = world.drive_curves(tmp_path / "run", pose=False, stamps_s=np.linspace(0, 12, 241))
    result = run_odometry(run)
    write_results(result, tmp_path / "out")
    names = ["sigma_x", "sigma_y", "sigma_yaw"]
    odometer, estimate = (
        numbers(tmp_path / "out" / f"{name}.csv", names) for name in ("odometer", "estimate")
    )
    np.testing.assert_array_equal(estimate, odometer)
    assert (estimate[-1] > 2 * result.replay.sigmas[-1, :3]).all()


def test_with_poses_deviations_of_the_estimate_are_those_of_the_filter(curvy_out, curvy_result):
    found = numbers(curvy_out / "estimate.csv", ["sigma_x", "sigma_y", "sigma_yaw"])
    np.testing.assert_allclose(found, curvy_result.replay.sigmas[:, :3], atol=1e-6)


@pytest.mark.parametrize("poses", [True, False])
def test_a_run_too_short_to_judge_is_still_strict_json(tmp_path, world, poses):
    run = world.drive_curves(tmp_path / "run", pose=poses, stamps_s=np.array([0.0, 0.05]))
    write_results(run_odometry(run), tmp_path / "out")
    content = strict((tmp_path / "out" / "result.json").read_text())
    assert content["reference"] is None
    assert content["errors"] == {}


def test_the_same_input_gives_the_same_bytes(across_run, classifier, across_out, tmp_path):
    again = run_odometry(across_run, model=classifier, terrain="gravel")
    written = write_results(again, tmp_path)
    for file in written:
        assert file.read_bytes() == (across_out / file.name).read_bytes(), file.name


def test_learned_toml_reads_back_and_starts_the_next_run(curvy_out, curvy_result, curvy_run):
    assert list(read_parameters(curvy_out / "learned.toml").terrains) == ["sand"]
    after = run_odometry(curvy_run, parameters=curvy_out / "learned.toml")
    assert after.initial_terrain == "sand"
    start, end = after.replay.estimates[0], curvy_result.replay.estimates[-1]
    np.testing.assert_allclose(start.mean[3:6], end.mean[3:6], atol=1e-12)


def test_where_nothing_was_learned_there_is_no_file_that_cannot_be_read(tmp_path, world):
    result = run_odometry(world.drive_curves(tmp_path / "run", pose=False))
    write_results(result, tmp_path / "out")
    assert not (tmp_path / "out" / "learned.toml").exists()


def test_no_table_of_an_earlier_run_stays_behind(across_result, across_run, tmp_path):
    """With vision first, then without, into one folder."""
    write_results(across_result, tmp_path)
    assert (tmp_path / "terrain.csv").exists()
    write_results(run_odometry(across_run), tmp_path)
    assert not (tmp_path / "terrain.csv").exists()
    assert strict((tmp_path / "result.json").read_text())["switches"] == []


@pytest.mark.parametrize(
    ("source", "origin"),
    [
        ({"origin": [48.1, 11, 519.5]}, [48.1, 11.0, 519.5]),
        ({"origin": [48.1, 11]}, [48.1, 11.0]),
        (
            {"origin": {"latitude": 48.1, "longitude": 11.0, "altitude": 519.5}},
            [48.1, 11.0, 519.5],
        ),
        ({"origin": {"latitude": 48.1}}, None),
        ({"origin": [48.1]}, None),
        ({"origin": [48.1, float("nan")]}, None),
        ({"origin": [True, False]}, None),
        ({"origin": "Munich"}, None),
        ("anything", None),
    ],
)
def test_the_origin_that_run_toml_says_is_kept(curvy_result, source, origin):
    run = curvy_result.run
    run = replace(run, settings={**run.settings, "source": source})
    content = result_table(replace(curvy_result, run=run))
    assert content["origin"] == origin
    assert content["robot"]["track_width"] == run.robot.track_width


def test_reference_tum_is_reference_csv_and_is_not_there_without_a_yaw(curvy_result, tmp_path):
    write_results(curvy_result, tmp_path)
    table = np.genfromtxt(tmp_path / "reference.csv", delimiter=",", names=True)
    poses = read_trajectory(tmp_path / "reference.tum").poses
    np.testing.assert_allclose(poses[:, 0, 3], table["x"], atol=1e-5)
    yaw = np.arctan2(poses[:, 1, 0], poses[:, 0, 0])
    np.testing.assert_allclose(np.sin(yaw - table["yaw"]), 0.0, atol=1e-5)
    positions = curvy_result.reference.poses.copy()
    positions[3, 2] = np.nan
    without = replace(curvy_result, reference=replace(curvy_result.reference, poses=positions))
    write_results(without, tmp_path)
    assert not (tmp_path / "reference.tum").exists()
