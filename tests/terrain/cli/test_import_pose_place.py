"""`import RUN --pose FILE` says whose poses it takes them for."""

import shutil

import numpy as np
import pytest
from click.testing import CliRunner

from odometry.io.trajectory_files import write_trajectory
from odometry.recording.run import Run
from odometry.trajectory import SpatialTrajectory, Trajectory
from terrain.cli.main import cli


@pytest.mark.parametrize(
    ("table", "sensors", "said"),
    [
        ("pose", "", True),
        ("pose", "\n[sensors]\npose = [0.3, 0.0, 0.5]\n", False),
        ("truth", "", False),
    ],
)
def test_the_place_of_a_camera_is_asked_for_where_it_is_not_stated(
    tmp_path, curvy_run, table, sensors, said
):
    """Poses of a camera 0.3 m ahead gave x_icr = -0.28 m with an interval of millimetres."""
    folder = tmp_path / "run"
    shutil.copytree(curvy_run, folder)
    poses = Run.read(folder).pose
    for name in ("pose.csv", "truth.csv"):
        (folder / name).unlink(missing_ok=True)
    with (folder / "run.toml").open("a") as settings:
        settings.write(sensors)
    trajectory = Trajectory(poses.stamps_s, np.asarray(poses.stack("x", "y", "yaw")))
    (file,) = write_trajectory(tmp_path, "slam", SpatialTrajectory.from_plane(trajectory), "tum")
    answer = CliRunner().invoke(cli, ["import", str(folder), f"--{table}", str(file)])
    assert answer.exit_code == 0, answer.output
    assert ("write its place, [sensors] pose" in answer.output) is said
