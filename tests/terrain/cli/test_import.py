"""`import`: from bags to a run folder that is checked, and what is said on the way."""

import json
import tomllib

import numpy as np
import pytest
from click.testing import CliRunner

from odometry.checks.recording import check_recording
from odometry.errors import OdometryError
from odometry.recording.run import Run
from terrain.cli.main import cli
from tests.odometry.bags.made_bags import RADIUS_M, Bag, course, half_turn

JOINTS = ["front_left_wheel", "front_right_wheel", "rear_left_wheel", "rear_right_wheel"]
SIZE = ("--wheel-radius", "0.15", "--track-width", "0.6")


@pytest.fixture
def bag(tmp_path):
    """A drive with wheels, a reference whose turns are a third smaller, and its own odometry."""
    made = Bag("mcap")
    for t_s, left, right, x, y, yaw in course(30.0):
        made.joints(t_s, JOINTS, np.zeros(4), [left / RADIUS_M, right / RADIUS_M] * 2)
        made.pose_stamped("/mocap/pose", t_s, made.pose((x, y, 0), half_turn(0.7 * yaw)))
        made.odometry("/odom", t_s, made.pose((x, y, 0), half_turn(yaw)), made.twist(0, 0))
    return made.write(tmp_path / "drive")


def call(*arguments):
    return CliRunner().invoke(cli, ["import", *map(str, arguments)])


def test_a_bag_becomes_a_run_that_is_checked(bag, tmp_path):
    out = tmp_path / "my_run"
    answer = call(bag, "--out", out, *SIZE)
    assert answer.exit_code == 0, answer.output
    assert f"Wrote the run {out}:" in answer.stdout
    assert "odometry.csv: 600 rows from /joint_states" in answer.stdout
    assert f"{out}:" in answer.stdout.splitlines() or f"{out}: no findings" in answer.stdout
    assert answer.stdout.splitlines()[-1].startswith("Next: terrain-odometry ")
    assert len(Run.read(out).odometry) == 600
    assert json.loads((out / "terrain-odometry.json").read_text())["verb"] == "import"


def test_topics_are_listed_with_what_is_guessed(bag):
    answer = call(bag, "--list")
    assert answer.exit_code == 0
    *listed, note, _ = answer.stdout.splitlines()
    lines = {line.split("/", 1)[1].split()[0]: line for line in listed}
    assert lines["joint_states"].startswith("*")
    assert "20 Hz" in lines["joint_states"]
    assert "600" in lines["joint_states"]
    assert "reference: poses" in lines["mocap/pose"]
    assert not lines["odom"].startswith("*")
    assert note.startswith("Note: ")
    assert "add --wheel-radius METRES. To measure it" in note
    assert answer.stdout.splitlines()[-1].startswith("Next: terrain-odometry import ")


def test_a_bag_without_wheels_is_listed_with_the_option_that_names_them(tmp_path):
    made = Bag("mcap")
    made.define("a_robot/msg/Pair", "float64 a\nfloat64 b\n")
    for t_s, left, right, x, y, yaw in course(5.0):
        made.pose_stamped("/mocap/pose", t_s, made.pose((x, y, 0), half_turn(yaw)))
        made.add(
            "/pair", "a_robot/msg/Pair", t_s, made.message("a_robot/msg/Pair", a=left, b=right)
        )
    answer = call(made.write(tmp_path / "drive"), "--list")
    assert answer.exit_code == 0
    assert answer.stdout.splitlines()[-1].endswith(" --wheels TOPIC")


def test_a_list_of_poses_alone_says_that_there_are_no_wheel_speeds(tmp_path):
    made = Bag("mcap")
    for t_s, _, _, x, y, yaw in course(5.0):
        made.pose_stamped("/mocap/pose", t_s, made.pose((x, y, 0), half_turn(yaw)))
    answer = call(made.write(tmp_path / "drive"), "--list")
    assert answer.exit_code == 0
    assert answer.stdout.splitlines()[-1].startswith("Note: the bag has no wheel speeds")


def test_a_missing_number_stops_the_import_and_nothing_is_written(bag, tmp_path):
    answer = call(bag, "--out", tmp_path / "my_run", "--track-width", "0.6")
    assert answer.exit_code == 1
    assert isinstance(answer.exception, OdometryError)
    assert "add --wheel-radius METRES. To measure it, roll" in str(answer.exception)
    assert not (tmp_path / "my_run").exists()


def test_a_map_says_what_is_taken_and_options_override_it(bag, tmp_path):
    file = tmp_path / "map.toml"
    file.write_text(
        'time = "log"\nother_odometry = []\n[robot]\ntrack_width = 0.5\nwheel_radius = 0.3\n'
        '[wheels]\nleft = ["rear_left_wheel"]\nright = ["rear_right_wheel"]\nright_sign = -1\n'
        '[reference]\ntopic = "none"\n'
    )
    answer = call(bag, "--out", tmp_path / "my_run", "--map", file, "--track-width", "0.7")
    assert answer.exit_code == 0, answer.output
    run = Run.read(tmp_path / "my_run")
    speeds = np.array(list(course(30.0)))[:, 1:3]
    assert run.odometry.stack("v_left", "v_right") == pytest.approx(speeds * [2, -2], abs=1e-7)
    assert run.settings["robot"] == {"track_width": 0.7, "wheel_radius": 0.3}
    assert not (run.folder / "pose.csv").exists()
    assert not (run.folder / "other_odometry").exists()
    assert tomllib.loads((run.folder / "run.toml").read_text())["source"]["time"] == "log"


@pytest.mark.parametrize(
    ("text", "words"),
    [
        ("[wheel]\n", "did you mean wheels"),
        ("[robot]\ntrack = 1\n", "did you mean track_width"),
        ('time = "now"\n', "expected one of auto, header, log"),
        ('[wheels]\nleft = "a"\n', "expected a list"),
        ('[wheels]\ntopic = "/nothing"\n', "there is no topic '/nothing'"),
        ('[imu]\ntopic = "/odom"\n', "cannot be used as imu"),
    ],
)
def test_a_map_with_a_fault_is_named(text, words, bag, tmp_path):
    file = tmp_path / "map.toml"
    file.write_text(text)
    answer = call(bag, "--out", tmp_path / "my_run", "--map", file, *SIZE)
    assert answer.exit_code == 1
    assert words in str(answer.exception)


@pytest.mark.parametrize("inside", [False, True])
def test_a_bag_where_a_run_is_expected_names_the_import(inside, bag, tmp_path):
    path = next(bag.glob("*.mcap")) if inside else bag
    answer = CliRunner().invoke(cli, ["run", str(path), "--out", str(tmp_path / "results")])
    words = f"terrain-odometry import {path} --out drive_run"
    assert "this is a bag" in str(answer.exception)
    assert words in str(answer.exception)
    (found,) = check_recording(path).findings
    assert words in found.line


def test_a_path_that_is_missing_and_a_call_without_out_are_reported(bag, tmp_path):
    answer = call(tmp_path / "nothing.bag", "--out", tmp_path / "my_run")
    assert "there is no such file or folder" in str(answer.exception)
    answer = call(bag)
    assert answer.exit_code == 2
    assert "--list" in answer.output
