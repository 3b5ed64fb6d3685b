"""A trajectory of another program as pose.csv of a run."""

from pathlib import Path

import numpy as np
import pytest
from scipy.spatial.transform import Rotation

from odometry.errors import TrajectoryError
from odometry.geometry import se3
from odometry.geometry.se3 import OPTICAL_FROM_CAMERA
from odometry.io.csv_table import read_csv_table, write_csv_table
from odometry.io.trajectory_files import to_optical
from odometry.io.trajectory_poses import doubt_of_axes, pose_columns, poses_within
from odometry.tables.table import Table
from odometry.trajectory import SpatialTrajectory


def odometry(first_s, last_s):
    stamps_s = np.linspace(first_s, last_s, 5)
    return Table(Path("odometry.csv"), {"t": stamps_s}, np.arange(2, 7))


def driving(stamps_s):
    """A circle to the left over a hill, nose along the way."""
    yaw = 0.3 * (stamps_s - stamps_s[0])
    places = np.column_stack([np.sin(yaw), 1 - np.cos(yaw), 0.1 * np.sin(yaw)]) * 4
    angles = np.column_stack([0 * yaw + 0.05, -0.1 * np.cos(yaw), yaw])
    return SpatialTrajectory(stamps_s, se3.pose(places, se3.rotation_from_roll_pitch_yaw(angles)))


def test_every_pose_is_a_row(tmp_path):
    moving = driving(np.linspace(99, 104, 11))
    write_csv_table(tmp_path / "pose.csv", pose_columns(moving))
    table = read_csv_table(tmp_path / "pose.csv", ["t", "x", "y", "yaw"])
    assert table.stamps_s.tolist() == moving.stamps_s.tolist()
    np.testing.assert_allclose(table.stack("x", "y", "z"), moving.positions_m, atol=1e-9)
    of = Rotation.from_euler("ZYX", table.stack("yaw", "pitch", "roll")).as_matrix()
    np.testing.assert_allclose(of, moving.poses[:, :3, :3], atol=1e-8)


def test_poses_of_another_clock_are_refused():
    assert poses_within(np.linspace(99, 104, 11), odometry(100, 110)) == 9
    with pytest.raises(TrajectoryError, match=r"99.000 to 104.000 s.* 0.000 to 60.000 s"):
        poses_within(np.linspace(99, 104, 11), odometry(0, 60))


def test_poses_of_a_camera_are_doubted():
    moving = driving(np.linspace(0, 5, 11))
    assert doubt_of_axes(moving) == ""
    assert "along its z axis; expected x forward" in doubt_of_axes(to_optical(moving))


def test_poses_that_are_too_rare_for_the_turns_say_nothing_of_axes():
    """After 8 s of this circle the chord to the next pose points to the side, and back."""
    assert doubt_of_axes(driving(np.arange(0, 60, 8.0))) == ""


def test_a_camera_in_a_map_whose_z_is_up_is_not_sent_to_optical_axes():
    moving = driving(np.linspace(0, 5, 11))
    turn = se3.pose(np.zeros(3), OPTICAL_FROM_CAMERA)  # the body alone, not the map
    said = doubt_of_axes(SpatialTrajectory(moving.stamps_s, moving.poses @ turn.T))
    assert "optical frame" in said
    assert "base frame" in said
    assert "--axes" not in said
    assert "--axes optical" in doubt_of_axes(to_optical(moving))


@pytest.mark.parametrize("of", [None, [0.0, 0.0, 1.2]])
def test_one_rotation_in_all_rows_is_no_yaw(of):
    moving = driving(np.linspace(0, 5, 11))
    turn = np.eye(3) if of is None else se3.rotation_from_roll_pitch_yaw(np.array([of]))[0]
    columns = pose_columns(SpatialTrajectory(moving.stamps_s, se3.pose(moving.positions_m, turn)))
    assert list(columns) == ["t", "x", "y", "yaw", "z"]
    assert np.isnan(columns["yaw"]).all()


def test_a_straight_drive_along_x_keeps_its_yaw():
    stamps_s = np.linspace(0, 5, 11)
    turn = se3.rotation_from_roll_pitch_yaw(np.array([[0.0, 0.0, 0.6]]))[0]
    places = stamps_s[:, None] * turn[:, 0]
    columns = pose_columns(SpatialTrajectory(stamps_s, se3.pose(places, turn)))
    np.testing.assert_allclose(columns["yaw"], 0.6)


def test_positions_of_a_camera_without_rotations_are_doubted():
    moving = driving(np.linspace(0, 5, 11))
    in_plane = SpatialTrajectory(moving.stamps_s, se3.pose(moving.positions_m, np.eye(3)))
    assert doubt_of_axes(in_plane) == ""
    assert "these need --axes optical" in doubt_of_axes(to_optical(in_plane))


@pytest.mark.parametrize(
    ("begin_s", "since"),
    [(1764510000 - 315964800 + 18, "6 January 1980"), (49218.0, "the start of a week"), (5.0, "")],
)
def test_gps_time_is_named(begin_s, since):
    """1764510000 is 30 November 2025, a Sunday, 13:40 UTC: 49,200 s of the GPS week and 18 more."""
    with pytest.raises(TrajectoryError) as refused:
        poses_within(begin_s + np.arange(100.0), odometry(1764510000.0, 1764510300.0))
    assert ("GPS time" in str(refused.value)) == bool(since)
    assert since in str(refused.value)
    assert str(refused.value).endswith("Add that to their stamps") == bool(since)


@pytest.mark.parametrize("hours", [-2.0, 5.5])
def test_another_time_zone_is_named_with_what_to_add(hours):
    begin_s = 1764510000.0
    with pytest.raises(TrajectoryError) as refused:
        poses_within(begin_s - 3600 * hours + np.arange(100.0), odometry(begin_s, begin_s + 99))
    said = str(refused.value)
    assert f"moved by {hours:+g} hours" in said
    assert said.endswith(f"Then add {3600 * hours:g} s to their stamps")
