"""`import RUN --pose FILE`: a trajectory of another program as the poses of a run."""

import shutil

import numpy as np
import pytest
from click.testing import CliRunner

from odometry.errors import OdometryError
from odometry.io.trajectory_files import FORMATS, write_trajectory
from odometry.outputs.manifest import read_manifest
from odometry.recording.run import Run
from odometry.trajectory import SpatialTrajectory, Trajectory
from terrain.cli.main import cli
from tests.odometry.bags.made_bags import Bag, course, half_turn


@pytest.fixture
def run(tmp_path, curvy_run):
    """A run folder without poses, and the poses that it had."""
    folder = tmp_path / "run"
    shutil.copytree(curvy_run, folder)
    table = Run.read(folder).pose
    (folder / "pose.csv").unlink()
    (folder / "truth.csv").unlink(missing_ok=True)
    return folder, Trajectory(table.stamps_s, table.stack("x", "y", "yaw"))


def call(*arguments):
    return CliRunner().invoke(cli, ["import", *map(str, arguments)])


@pytest.mark.parametrize("name", FORMATS)
@pytest.mark.parametrize("table", ["pose", "truth"])
def test_a_run_gets_the_poses_of_every_format(run, tmp_path, name, table):
    folder, poses = run
    files = write_trajectory(tmp_path, "slam", SpatialTrajectory.from_plane(poses), name)
    times = ["--times", files[1]] if len(files) > 1 else []
    answer = call(folder, f"--{table}", files[0], *times)
    assert answer.exit_code == 0, answer.output
    assert f"{table}.csv: {len(poses)} rows from {files[0]}" in answer.output
    found = getattr(Run.read(folder), table)
    np.testing.assert_allclose(found.stamps_s, poses.stamps_s, atol=1e-9)
    np.testing.assert_allclose(found.stack("x", "y", "yaw"), poses.poses, atol=2e-9)
    assert "Next: terrain-odometry" in answer.output


def test_poses_that_are_there_stay(run, tmp_path):
    folder, poses = run
    (file,) = write_trajectory(tmp_path, "slam", SpatialTrajectory.from_plane(poses), "tum")
    (folder / "pose.csv").write_text("mine")
    answer = call(folder, "--pose", file)
    assert isinstance(answer.exception, OdometryError)
    assert "pose.csv is there already" in str(answer.exception)
    assert (folder / "pose.csv").read_text() == "mine"


def test_nothing_is_written_where_one_file_is_wrong(run, tmp_path):
    folder, poses = run
    (file,) = write_trajectory(tmp_path, "slam", SpatialTrajectory.from_plane(poses), "tum")
    later = Trajectory(poses.stamps_s + 1e6, poses.poses)
    (wrong,) = write_trajectory(tmp_path, "later", SpatialTrajectory.from_plane(later), "tum")
    answer = call(folder, "--pose", file, "--truth", wrong)
    assert "stamps of one clock" in str(answer.exception)
    assert not (folder / "pose.csv").exists()


def test_poses_of_a_camera_need_their_axes(run, tmp_path):
    folder, poses = run
    file, times = write_trajectory(tmp_path, "a", SpatialTrajectory.from_plane(poses), "kitti")
    answer = call(folder, "--pose", file, "--times", times, "--axes", "robot")
    assert "expected x forward" in answer.output
    assert call(folder, "--pose", file).exit_code == 1  # it is there, and times are missing


def test_axes_without_a_file_are_a_usage_error(run):
    assert call(run[0], "--axes", "optical").exit_code == 2
    assert call(run[0], run[0], "--pose", "nowhere.tum").exit_code == 2


def test_a_bag_gets_the_poses_of_a_file_instead_of_its_reference(tmp_path):
    """A mocap in the bag, with turns a third smaller, is not taken."""
    made, rows = Bag("mcap"), np.array(list(course(30.0)))
    for t_s, left, right, x, y, yaw in rows:
        made.joints(t_s, ["left_wheel", "right_wheel"], np.zeros(2), [left, right])
        made.pose_stamped("/mocap/pose", t_s, made.pose((x, y, 0), half_turn(0.7 * yaw)))
    bag = made.write(tmp_path / "drive")
    call(bag, "--out", tmp_path / "first", "--wheel-radius", "1", "--track-width", "0.6")
    stamps_s = Run.read(tmp_path / "first").odometry.stamps_s
    poses = Trajectory(stamps_s, rows[: len(stamps_s), 3:])
    (file,) = write_trajectory(tmp_path, "slam", SpatialTrajectory.from_plane(poses), "tum")
    size = ("--wheel-radius", "1", "--track-width", "0.6")
    both = ("--pose", file, "--reference", "/mocap/pose")
    assert call(bag, "--out", tmp_path / "third", *both, *size).exit_code == 2
    answer = call(bag, "--out", tmp_path / "second", "--pose", file, *size)
    assert answer.exit_code == 0, answer.output
    assert f"pose.csv: {len(poses)} rows from {file}" in answer.output
    found = Run.read(tmp_path / "second").pose.stack("x", "y", "yaw")
    np.testing.assert_allclose(found[:, :2], poses.poses[:, :2], atol=1e-8)
    assert "pose.csv" in (tmp_path / "second" / "terrain-odometry.json").read_text()


def test_the_manifest_of_an_imported_run_names_what_was_added(tmp_path):
    """So that the folder can be made anew, and says where its poses come from."""
    bag = Bag("mcap")
    places = []
    for t_s, left, right, x, y, yaw in course():
        bag.joints(t_s, ["left_wheel", "right_wheel"], np.zeros(2), [left, right])
        places.append((x, y, yaw))
    made = ("import", bag.write(tmp_path / "drive"), "--out", tmp_path / "run")
    size = ("--wheel-radius", 1, "--track-width", 0.6)
    assert CliRunner().invoke(cli, list(map(str, made + size))).exit_code == 0
    stamps_s = Run.read(tmp_path / "run").odometry.stamps_s
    path = SpatialTrajectory.from_plane(Trajectory(stamps_s, np.array(places)))
    (file,) = write_trajectory(tmp_path, "slam", path, "tum")
    assert call(tmp_path / "run", "--pose", file).exit_code == 0
    manifest = read_manifest(tmp_path / "run")
    assert "pose.csv" in manifest.files
    (added,) = manifest.made["added"]
    assert (added["file"], added["path"]) == ("pose.csv", str(file))
    assert len(added["sha256"]) == 64
    again = CliRunner().invoke(cli, list(map(str, made + size)))
    assert again.exit_code == 0, again.output
    assert not (tmp_path / "run" / "pose.csv").exists()


@pytest.mark.parametrize("quaternion", ["0 0 0 1", "0 0 0 0"])
def test_positions_without_rotations_have_no_yaw(run, tmp_path, quaternion):
    folder, poses = run
    rows = zip(poses.stamps_s, poses.poses[:, 0], poses.poses[:, 1], strict=True)
    file = tmp_path / "positions.tum"
    file.write_text("".join(f"{t:.6f} {x:.9f} {y:.9f} 0 {quaternion}\n" for t, x, y in rows))
    assert "no yaw, which truth.csv needs" in str(call(folder, "--truth", file).exception)
    answer = call(folder, "--pose", file)
    assert answer.exit_code == 0, answer.output
    assert "they are not measured, and yaw is left empty" in answer.output
    assert "warning" not in answer.output
    found = Run.read(folder).pose
    assert np.isnan(found["yaw"]).all()
    np.testing.assert_allclose(found["x"], poses.poses[:, 0], atol=1e-8)


@pytest.mark.parametrize(
    ("name", "columns", "order"),
    [("tum", [0, 1, 2, 3, 7, 4, 5, 6], "qw qx qy qz"), ("euroc", [0, 1, 2, 3, 5, 6, 7, 4], "qx")],
)
def test_quaternions_of_the_other_order_are_refused(run, tmp_path, name, columns, order):
    folder, poses = run
    all_round = poses.poses + np.linspace(0, 6, len(poses))[:, None] * [0, 0, 1]
    turning = SpatialTrajectory.from_plane(Trajectory(poses.stamps_s, all_round))
    (file,) = write_trajectory(tmp_path, "slam", turning, name)
    separator = "," if name == "euroc" else " "
    rows = [line.split(separator) for line in file.read_text().splitlines() if line[0] != "#"]
    other = tmp_path / file.name.replace("slam", "other")
    other.write_text("\n".join(separator.join(row[k] for k in columns) for row in rows))
    answer = call(folder, "--pose", other)
    assert f"where its quaternions are in the order {order}" in str(answer.exception)
    assert not (folder / "pose.csv").exists()
    assert call(folder, "--pose", file).exit_code == 0


def test_a_run_folder_without_its_settings_is_no_bag(run, tmp_path):
    folder, poses = run
    (file,) = write_trajectory(tmp_path, "slam", SpatialTrajectory.from_plane(poses), "tum")
    (folder / "run.toml").unlink()
    answer = call(folder, "--pose", file)
    assert "a run folder needs run.toml" in str(answer.exception)
    assert not (folder / "pose.csv").exists()
