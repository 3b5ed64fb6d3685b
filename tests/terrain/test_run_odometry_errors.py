"""What `run_odometry` cannot work with, said in one line."""

import pytest

from odometry.errors import OdometryError, RunFolderError
from odometry.recording.run import Run
from terrain.errors import CameraError, ModelFileError
from terrain.main_job import run_odometry


def test_a_model_without_images_is_an_error(tmp_path, world, classifier):
    folder = world.drive_curves(tmp_path / "run")
    for tables in ({}, {"camera": world.camera}):
        world.write_toml(folder / "run.toml", robot=world.robot, **tables)
        with pytest.raises(RunFolderError, match=r"model was given.*no images\.csv"):
            run_odometry(folder, model=classifier)


def test_a_model_without_a_camera_is_an_error(tmp_path, world, classifier):
    folder = world.drive_straight(tmp_path / "run", world.across, 0.3)
    world.write_toml(folder / "run.toml", robot=world.robot)
    with pytest.raises(RunFolderError, match=r"model was given.*no \[camera\] in run\.toml"):
        run_odometry(Run.read(folder), model=classifier)


def test_a_wrong_camera_and_a_wrong_model_are_errors(tmp_path, world, classifier, across_run):
    folder = world.drive_straight(tmp_path / "run", world.across, 0.3)
    camera = {key: value for key, value in world.camera.items() if key != "mount"}
    world.write_toml(folder / "run.toml", robot=world.robot, camera=camera)
    with pytest.raises(CameraError, match=r"run\.toml: \[camera\]"):
        run_odometry(Run.read(folder), model=classifier)
    with pytest.raises(ModelFileError, match=r"run\.toml"):
        run_odometry(across_run, model=across_run / "run.toml")


def test_images_of_another_size_than_the_cameras_name_image_and_setting(
    tmp_path, world, classifier
):
    folder = world.drive_straight(tmp_path / "run", world.across, 0.3)
    camera = world.camera | {"image_size": [320, 240]}
    world.write_toml(folder / "run.toml", robot=world.robot, camera=camera)
    with pytest.raises(OdometryError, match=r"000\.png.*160x120.*320x240"):
        run_odometry(Run.read(folder), model=classifier)


def test_a_run_folder_that_is_none_is_an_error(tmp_path):
    with pytest.raises(RunFolderError, match="no such folder"):
        run_odometry(tmp_path / "absent")


def test_a_folder_that_the_check_refuses_is_an_error(tmp_path, world):
    folder = world.drive_curves(tmp_path / "run")
    header, *rows = (folder / "odometry.csv").read_text().splitlines()
    swapped = [rows[0], rows[2], rows[1], *rows[3:]]
    (folder / "odometry.csv").write_text("\n".join([header, *swapped]) + "\n")
    with pytest.raises(RunFolderError, match=r"odometry\.csv"):
        run_odometry(folder)
