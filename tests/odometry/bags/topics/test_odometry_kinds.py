"""Odometry of cameras, lidar, satellites and filters is not taken as that of the wheels."""

import numpy as np
import pytest

from odometry.bags.topics.topic_list import topic_lines
from odometry.errors import BagError
from tests.odometry.bags.imports import imported, looked_at
from tests.odometry.bags.made_bags import TRACK_M, Bag, course, half_turn

COURSE = list(course(8.0))
SLIPS = 0.7  # of a turn of the treads that the robot turns


def add(bag, topic, *, slip=1.0, every=1, side=0.0, rise=0.0, **frames):
    """Odometry of the course: of the wheels, or of the robot, which turns less."""
    for t_s, left, right, x, y, yaw in COURSE[::every]:
        twist = bag.message(
            "geometry_msgs/msg/Twist",
            linear=bag.vector((left + right) / 2, side * np.sin(t_s), 0),
            angular=bag.vector(0, 0, slip * (right - left) / TRACK_M),
        )
        pose = bag.pose((x, y, rise * t_s), half_turn(slip * yaw))
        bag.odometry(topic, t_s, pose, twist, **frames)


def taken(tmp_path, bag, **options):
    run, said = imported(tmp_path / "run", bag.write(tmp_path / "drive"), **options)
    return run.settings["source"]["topics"], said


WHEELS = (
    "/husky_velocity_controller/odom",
    "/wheel/odometry",
    "/encoder_odom",
    "/diff_drive_controller/odom",
    "/mavros/wheel_odometry/odom",
    "/rtabmap/wheel_odom",
    "/base/odom",
)
OTHERS = (
    "/zed2/zed_node/odom",
    "/camera/odom/sample",
    "/vio/odometry",
    "/Odometry",
    "/kiss/odometry",
    "/ouster/odom",
    "/novatel/oem7/odom",
    "/mavros/local_position/odom",
    "/odometry/filtered",
    "/odom_combined",
    "/visual_wheel_odometry",
)


@pytest.mark.parametrize("wheels", WHEELS)
def test_wheels_are_taken_though_another_odometry_has_more_messages(wheels, tmp_path):
    bag = Bag("mcap")
    for other in OTHERS:
        add(bag, other, slip=SLIPS)
    add(bag, wheels, every=3)
    topics, said = taken(tmp_path, bag)
    assert topics["wheels"] == wheels
    assert not any("is a guess" in note for note in said.notes)


@pytest.mark.parametrize("other", OTHERS)
def test_an_odometry_without_wheels_is_refused_and_named_with_the_option(other, tmp_path):
    bag = Bag("mcap")
    add(bag, other, slip=SLIPS)
    path = bag.write(tmp_path / "drive")
    with pytest.raises(BagError, match=rf"shows no slip.*: {other} \(.* by its name.*--wheels TOP"):
        imported(tmp_path / "run", path)
    assert not any("wheels:" in line for line in topic_lines(looked_at(path)[0]))


@pytest.mark.parametrize(
    ("signs", "words"),
    [
        ({"child": "camera_pose_frame"}, "visual odometry by its frame camera_pose_frame"),
        ({"child": "imu_link"}, "by its frame imu_link"),
        ({"child": "body", "world": "camera_init"}, "by its world camera_init"),
        ({"side": 0.05}, r"by its sideways speed, up to 0\.05 m/s"),
        ({"rise": 0.1}, "by its height, which changes by 0.8 m"),
    ],
)
def test_frames_and_motion_tell_another_odometry_of_a_plain_name(signs, words, tmp_path):
    bag = Bag("mcap")
    add(bag, "/odom", slip=SLIPS, **signs)
    with pytest.raises(BagError, match=words):
        imported(tmp_path / "run", bag.write(tmp_path / "drive"))


def test_a_plain_name_is_taken_and_said_to_be_a_guess(tmp_path):
    bag = Bag("mcap")
    add(bag, "/odom")
    topics, said = taken(tmp_path, bag)
    assert topics["wheels"] == "/odom"
    assert any("that /odom is of the wheels is a guess" in note for note in said.notes)
    assert not any("guess" in note for note in taken_as_named(tmp_path, bag).notes)


def taken_as_named(tmp_path, bag):
    path = bag.write(tmp_path / "again")
    return imported(tmp_path / "named", path, wheels__topic="/odom")[1]


def test_what_the_user_names_is_taken_with_a_note_and_is_no_reference_to_itself(tmp_path):
    bag = Bag("mcap")
    add(bag, "/vio/odometry", slip=SLIPS)
    topics, said = taken(tmp_path, bag, wheels__topic="/vio/odometry")
    assert topics == {"wheels": "/vio/odometry"}
    assert any("/vio/odometry looks like visual odometry" in note for note in said.notes)


def test_visual_odometry_is_a_reference_behind_satellites(tmp_path):
    bag = Bag("mcap")
    add(bag, "/vio/odometry", slip=SLIPS)
    add(bag, "/wheel/odometry")
    topics, said = taken(tmp_path, bag)
    assert topics["reference"] == "/vio/odometry"
    words = "/vio/odometry is visual odometry by its name, which may drift over a long drive"
    assert any(words in note for note in said.notes)
    for t_s, *_ in COURSE:
        bag.fix(t_s, 48.0, 11.0, 500.0)
    path = bag.write(tmp_path / "again")
    run, _ = imported(tmp_path / "second", path)
    assert run.settings["source"]["topics"]["reference"] == "/gps/fix"


def test_lidar_odometry_is_a_reference_before_satellites_which_are_said(tmp_path):
    bag = Bag("mcap")
    add(bag, "/Odometry", slip=SLIPS)
    add(bag, "/wheel/odometry")
    for t_s, *_ in COURSE:
        bag.fix(t_s, 48.0, 11.0, 500.0)
    topics, said = taken(tmp_path, bag)
    assert topics["reference"] == "/Odometry"
    assert any(note.endswith("--reference /gps/fix takes the fixes") for note in said.notes)


def test_speeds_of_satellites_are_no_wheels(tmp_path):
    bag = Bag("mcap")
    for t_s, *_ in COURSE:
        twist = bag.message(
            "geometry_msgs/msg/TwistStamped", header=bag.header(t_s), twist=bag.twist(1, 0)
        )
        bag.add("/ublox/fix_velocity", "geometry_msgs/msg/TwistStamped", t_s, twist)
    with pytest.raises(BagError, match=r"/ublox/fix_velocity \(odometry of satellites"):
        imported(tmp_path / "run", bag.write(tmp_path / "drive"))


def test_wheel_odometry_that_moves_sideways_is_said(tmp_path):
    bag = Bag("mcap")
    add(bag, "/wheel/odometry", side=0.4)
    topics, said = taken(tmp_path, bag)
    assert topics["wheels"] == "/wheel/odometry"
    assert any("no plain wheel odometry by its sideways speed" in note for note in said.notes)


def test_a_twist_in_the_axes_of_the_world_is_not_taken(tmp_path):
    """Its poses are differenced: they are the same in any axes."""
    bag = Bag("mcap")
    for t_s, left, right, x, y, yaw in COURSE:
        ahead, turn = (left + right) / 2, (right - left) / TRACK_M
        twist = bag.message(
            "geometry_msgs/msg/Twist",
            linear=bag.vector(ahead * np.cos(yaw + 1), ahead * np.sin(yaw + 1), 0),
            angular=bag.vector(0, 0, turn),
        )
        bag.odometry("/wheel/odometry", t_s, bag.pose((x, y, 0), half_turn(yaw)), twist)
    run, said = imported(tmp_path / "run", bag.write(tmp_path / "drive"))
    true = np.array(COURSE)[:-1, 1:3]
    assert run.odometry.stack("v_left", "v_right") == pytest.approx(true, abs=1e-6)
    assert any("as one in the world's axes does" in note for note in said.notes)


def test_of_two_equal_topics_the_other_is_said(tmp_path):
    bag = Bag("mcap")
    add(bag, "/wheel/odometry")
    add(bag, "/encoder/odometry", every=2)
    topics, said = taken(tmp_path, bag)
    assert topics["wheels"] == "/wheel/odometry"
    words = "/encoder/odometry would fit as well as /wheel/odometry; --wheels /encoder/odometry"
    assert any(words in note for note in said.notes)
