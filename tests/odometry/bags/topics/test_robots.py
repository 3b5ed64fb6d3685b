"""Bags of several robots: no sensor of one is mixed with the wheels of another."""

import numpy as np
import pytest

from odometry.bags.topics.topic_roles import TopicMap
from tests.odometry.bags.imports import imported
from tests.odometry.bags.made_bags import RADIUS_M, Bag, course, half_turn

WHEELS = ["left_wheel", "right_wheel"]


def bag_of(*robots, poses="/{}/ground_truth"):
    """A bag with wheels of the first robot and measured poses of all."""
    bag = Bag("mcap")
    for t_s, left, right, x, y, yaw in course(8.0):
        rates = [left / RADIUS_M, right / RADIUS_M]
        bag.joints(t_s, WHEELS, np.zeros(2), rates, topic=f"/{robots[0]}/joint_states")
        for robot in robots[::-1]:
            topic = poses.format(robot)
            bag.odometry(topic, t_s, bag.pose((x, y, 0), half_turn(yaw)), bag.twist(0, 0))
    return bag


PLACES = ["/{}/ground_truth", "/vicon/{}/odom", "/robots/{}/slam/odom"]


@pytest.mark.parametrize("poses", PLACES)
@pytest.mark.parametrize(
    "robots", [("husky2", "husky1"), ("robot_b", "robot_a"), ("husky", "husky2")]
)
def test_the_reference_and_other_odometry_are_of_the_robot_of_the_wheels(robots, poses, tmp_path):
    bag = bag_of(*robots, poses=poses)
    run, said = imported(tmp_path / "run", bag.write(tmp_path / "drive"))
    source = run.settings["source"]["topics"]
    assert source["reference"] == poses.format(robots[0])
    assert not (run.folder / "other_odometry").exists()
    (note,) = [note for note in said.notes if note.startswith("robots: ")]
    assert f"there are {robots[0]}, {robots[1]}; {robots[0]} is taken" in note
    assert f"Left out: {poses.format(robots[1])}" in note


def test_a_sensor_of_another_robot_is_left_out_even_where_it_is_the_only_one(tmp_path):
    bag = bag_of("husky1")
    for t_s, *_ in course(8.0):
        bag.imu(t_s, (0, 0, 0), (0, 0, 9.8))
        _, *message = bag.written.pop()
        bag.add("/husky2/imu/data", *message)
    run, _ = imported(tmp_path / "run", bag.write(tmp_path / "drive"))
    assert "imu" not in run.settings["source"]["topics"]


def test_robots_of_other_names_are_known_by_the_same_topic_of_wheels(tmp_path):
    bag = bag_of("alpha", "bravo")
    for t_s, left, right, *_ in list(course(8.0))[::2]:
        bag.joints(t_s, WHEELS, np.zeros(2), [left, right], topic="/bravo/joint_states")
    path = bag.write(tmp_path / "drive")
    run, said = imported(tmp_path / "run", path)
    assert run.settings["source"]["topics"]["reference"] == "/alpha/ground_truth"
    assert any("--wheels /bravo/joint_states takes another" in note for note in said.notes)
    other, _ = imported(tmp_path / "second", path, wheels__topic="/bravo/joint_states")
    assert other.settings["source"]["topics"]["reference"] == "/bravo/ground_truth"


def test_robots_are_known_by_wheel_odometry_of_a_plain_name(tmp_path):
    bag = Bag("mcap")
    for t_s, left, right, x, y, yaw in course(8.0):
        pose, twist = bag.pose((x, y, 0), half_turn(yaw)), bag.twist((left + right) / 2, 0)
        bag.odometry("/alpha/odom", t_s, pose, twist)
        bag.odometry("/bravo/odom", t_s, pose, twist)
        bag.odometry("/bravo/slam", t_s, pose, twist)
    run, _ = imported(tmp_path / "run", bag.write(tmp_path / "drive"))
    assert run.settings["source"]["topics"] == {"wheels": "/alpha/odom"}


def test_the_base_frame_is_of_the_robot_of_the_wheels(tmp_path):
    bag = bag_of("husky2", "husky1")
    still = (1, 0, 0, 0)
    bag.transforms(
        "/tf_static",
        0.0,
        [
            bag.transform(0, "husky1/base_footprint", "husky1/gps", (0.1, 0, 0), still),
            bag.transform(0, "husky2/base_footprint", "tracker", (0.3, 0, 0), still),
        ],
    )
    for _, _, _, message in bag.written[:-1]:
        if hasattr(message, "child_frame_id"):
            message.child_frame_id = "tracker"
    run, _ = imported(tmp_path / "run", bag.write(tmp_path / "drive"))
    assert run.settings["sensors"]["pose"] == pytest.approx([0.3, 0, 0])


URDF = """<robot name="{name}"><link name="base_link"/><link name="wheel"><collision><geometry>
<cylinder radius="{radius}" length="0.1"/></geometry></collision></link><joint name="left_wheel"
type="continuous"><parent link="base_link"/><child link="wheel"/></joint></robot>"""


@pytest.mark.parametrize("first", [("husky1", "husky2"), ("husky2", "husky1")])
def test_the_description_is_of_the_robot_of_the_wheels(first, tmp_path):
    bag = bag_of("husky1", "husky2")
    radii = {"husky1": 0.15, "husky2": 0.3}
    for number, robot in enumerate(first):
        text = URDF.format(name=robot, radius=radii[robot])
        bag.text(f"/{robot}/robot_description", number, text)
    path = bag.write(tmp_path / "drive")
    size = TopicMap().overridden({"robot.track_width": 0.6})
    run, _ = imported(tmp_path / "run", path, topic_map=size, unsized=True)
    assert run.settings["robot"] == {"name": "husky1", "track_width": 0.6, "wheel_radius": 0.15}


def test_parts_of_one_robot_are_no_robots(tmp_path):
    """A camera with an odometry and an inertial sensor of its own, as beside the base."""
    bag = Bag("mcap")
    for t_s, left, right, x, y, yaw in course(8.0):
        pose, twist = bag.pose((x, y, 0), half_turn(yaw)), bag.twist((left + right) / 2, 0)
        bag.odometry("/base/odom", t_s, pose, twist)
        bag.odometry("/zed/odom", t_s, pose, twist)
        bag.joints(t_s, ["elbow"], [0.0], [0.0], topic="/arm/joint_states")
    run, said = imported(tmp_path / "run", bag.write(tmp_path / "drive"))
    assert run.settings["source"]["topics"] == {"wheels": "/base/odom", "reference": "/zed/odom"}
    assert not any(note.startswith("robots: ") for note in said.notes)
