"""Poses without an orientation or in several frames, and twists that no wheels have."""

import numpy as np
import pytest

from odometry.errors import BagError
from tests.odometry.bags.imports import imported
from tests.odometry.bags.made_bags import RADIUS_M, TRACK_M, Bag, course, half_turn

NAMES = ["left_wheel", "right_wheel"]
COURSE = np.array(list(course(8.0)))


def drive(add, *, wheels=True):
    bag = Bag("mcap")
    for row in COURSE:
        if wheels:
            bag.joints(row[0], NAMES, [], row[1:3] / RADIUS_M)
        add(bag, row)
    return bag


def import_of(bag, tmp_path, **options):
    return imported(tmp_path / "run", bag.write(tmp_path / "drive"), **options)


@pytest.mark.parametrize("of", ["odometry", "pose"])
def test_an_orientation_that_is_not_filled_in_is_no_yaw(of, tmp_path):
    """As robot_localization's odometry of satellites."""

    def add(bag, row):
        t_s, _, _, x, y, _ = row
        pose = bag.pose((x, y, 0), half_turn(0))
        if of == "odometry":
            bag.odometry("/odometry/gps", t_s, pose, bag.twist(0, 0), world="map")
        else:
            bag.pose_stamped("/mocap/pose", t_s, pose)

    run, said = import_of(drive(add), tmp_path)
    assert np.isnan(run.pose["yaw"]).all()
    np.testing.assert_allclose(run.pose["x"], COURSE[:, 3], atol=1e-6)
    assert any("its orientation never changes" in note for note in said.notes)


def test_a_robot_that_stands_keeps_its_yaw(tmp_path):
    def add(bag, row):
        bag.pose_stamped("/mocap/pose", row[0], bag.pose((1, 2, 0), half_turn(0.3)))

    run, said = import_of(drive(add), tmp_path)
    assert run.pose["yaw"] == pytest.approx(0.3)
    assert not any("orientation never changes" in note for note in said.notes)


def test_poses_in_another_frame_than_most_are_left_out(tmp_path):
    def add(bag, row):
        t_s, _, _, x, y, yaw = row
        bag.pose_stamped("/slam/pose", t_s, bag.pose((x, y, 0), half_turn(yaw)), "map")
        if t_s < 3:
            other = bag.pose((x + 2, y - 1, 0), half_turn(yaw + 1))
            bag.pose_stamped("/slam/pose", t_s + 0.02, other, "odom")

    run, said = import_of(drive(add), tmp_path)
    np.testing.assert_allclose(run.pose["x"], COURSE[:, 3], atol=1e-6)
    (loss,) = said.losses
    assert "60 messages dropped: a pose in the frame 'odom', where most are in 'map'" in loss


def twist_in_the_world(bag, row):
    t_s, left, right, _, _, yaw = row
    ahead = (left + right) / 2
    message = bag.message(
        "geometry_msgs/msg/TwistStamped",
        header=bag.header(t_s, "map"),
        twist=bag.message(
            "geometry_msgs/msg/Twist",
            linear=bag.vector(ahead * np.cos(yaw), ahead * np.sin(yaw), 0),
            angular=bag.vector(0, 0, (right - left) / TRACK_M),
        ),
    )
    bag.add("/wheel_twist", "geometry_msgs/msg/TwistStamped", t_s, message)


def test_a_twist_that_goes_sideways_is_no_speed_of_wheels(tmp_path):
    bag = drive(twist_in_the_world, wheels=False)
    with pytest.raises(
        BagError, match=r"/wheel_twist: its twist goes sideways by up to 0\.\d+ m/s"
    ):
        import_of(bag, tmp_path)
    (tmp_path / "again").mkdir()
    run, _ = import_of(bag, tmp_path / "again", wheels__values="velocity")
    assert len(run.odometry) == len(COURSE)


def test_the_separation_of_a_twist_is_said_where_the_user_does_not(tmp_path):
    def add(bag, row):
        t_s, left, right, x, y, yaw = row
        twist = bag.twist((left + right) / 2, (right - left) / TRACK_M)
        bag.odometry("/wheel_odom", t_s, bag.pose((x, y, 0), half_turn(yaw)), twist)

    bag = drive(add, wheels=False)
    _, said = import_of(bag, tmp_path)
    assert any("wheel_separation_multiplier" in note for note in said.notes)
    (tmp_path / "again").mkdir()
    _, said = import_of(bag, tmp_path / "again", wheels__separation=TRACK_M)
    assert not any("wheel_separation_multiplier" in note for note in said.notes)


@pytest.mark.parametrize(("topic", "is_said"), [("/cmd_vel", True), ("/wheels/velocity", False)])
def test_commands_that_are_taken_for_wheel_speeds_are_said(topic, is_said, tmp_path):
    def add(bag, row):
        t_s, left, right, *_ = row
        twist = bag.twist((left + right) / 2, (right - left) / TRACK_M)
        kind = "geometry_msgs/msg/TwistStamped"
        bag.add(topic, kind, t_s, bag.message(kind, header=bag.header(t_s), twist=twist))

    _, said = import_of(drive(add, wheels=False), tmp_path, wheels__topic=topic)
    assert any("holds commands" in note for note in said.notes) == is_said
