"""Imports that cannot go on say everything that is to be added, and what else to do."""

from types import SimpleNamespace

import numpy as np
import pytest
from click.testing import CliRunner

from odometry.bags.rows.camera_info import camera_table
from odometry.geometry.se3 import OPTICAL_FROM_CAMERA, pose
from terrain.cli.main import cli
from tests.odometry.bags.imports import imported
from tests.odometry.bags.made_bags import RADIUS_M, Bag, course

MATRIX = np.array([[50, 0, 32], [0, 50, 24], [0, 0, 1.0]])


@pytest.fixture
def drive():
    """Joint states of wheels, and an image."""
    bag = Bag("ros1")
    for t_s, left, right, *_ in course(10.0):
        rates = [left / RADIUS_M, right / RADIUS_M]
        bag.joints(t_s, ["left_wheel", "right_wheel"], np.zeros(2), rates)
    bag.image(0.5, np.zeros((48, 64), np.uint8), "mono8")
    return bag


def call(*arguments):
    return CliRunner().invoke(cli, ["import", *map(str, arguments)])


def test_the_list_ends_with_a_command_that_has_all_that_is_missing(drive, tmp_path):
    answer = call(drive.write(tmp_path / "drive.bag"), "--list")
    command = answer.output.splitlines()[-1]
    assert command.endswith("--out drive_run --wheel-radius METRES --track-width METRES")


def test_both_numbers_that_are_missing_are_asked_for_at_once(drive, tmp_path):
    answer = call(drive.write(tmp_path / "drive.bag"), "--out", tmp_path / "run")
    assert "--wheel-radius METRES" in str(answer.exception)
    assert "--track-width METRES" in str(answer.exception)


@pytest.mark.parametrize("whole_folder", [True, False])
def test_a_log_in_csv_is_told_what_becomes_of_it(tmp_path, whole_folder):
    file = tmp_path / "wheels.csv"
    file.write_text("t,left,right\n0,1,1\n")
    answer = call(tmp_path if whole_folder else file, "--out", tmp_path / "run")
    assert "rename its columns as in data/README.md" in str(answer.exception)


def test_a_fisheye_is_told_how_it_is_converted(drive, tmp_path):
    lens = [0.02, -0.005, 0.001, -0.0005]
    drive.camera_info(0.0, (64, 48), MATRIX, lens, model="equidistant")
    run, said = imported(tmp_path / "run", drive.write(tmp_path / "drive.bag"))
    assert "camera" not in run.settings
    assert any("camera RUN --file camera_info.yaml --out" in note for note in said.notes)


def test_the_mount_of_a_fisheye_is_not_lost():
    info = SimpleNamespace(k=MATRIX.ravel(), d=np.full(4, 0.01), p=np.zeros(12))
    info.distortion_model = "fisheye"
    ahead = pose(np.array([0.2, 0.0, 0.7]), OPTICAL_FROM_CAMERA.T)
    table, (note,) = camera_table(info, ahead, rectified=False)
    assert table == {}
    assert "--mount 0.2 0 0.7 0 0 0 --out camera --write" in note
