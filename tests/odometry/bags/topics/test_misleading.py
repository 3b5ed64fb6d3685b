"""Messages that name the cause: units, archives, maps, bags without wheels."""

import zipfile

import numpy as np
import pytest

from odometry.bags.topics.topic_roles import read_topic_map
from odometry.checks.recording import check_recording
from odometry.errors import BagError
from tests.odometry.bags.imports import imported, looked_at
from tests.odometry.bags.made_bags import RADIUS_M, Bag, course, half_turn

RPM = 60 / (2 * np.pi * RADIUS_M)  # of a metre a second


def drive(per_m_s):
    """Wheels that count `per_m_s` for each metre a second, and measured poses."""
    rng = np.random.default_rng(1)
    bag = Bag("mcap")
    bag.define("a_robot/msg/Wheels", "std_msgs/Header header\nfloat64 left\nfloat64 right\n")
    for t_s, left, right, x, y, yaw in course(60.0):
        mean, half = (left + right) / 2 / 0.93, 0.9 * (right - left)
        wheels = bag.message(
            "a_robot/msg/Wheels",
            header=bag.header(t_s),
            left=float(mean - half) * per_m_s,
            right=float(mean + half) * per_m_s,
        )
        bag.add("/wheels", "a_robot/msg/Wheels", t_s, wheels)
        place = (*rng.normal((x, y), 0.005), 0)
        bag.pose_stamped("/mocap/pose", t_s, bag.pose(place, half_turn(yaw)))
    return bag


@pytest.mark.parametrize("said", ["rad/s", "deg/s", "turns/s", "m/s", "mm/s"])
def test_a_wrong_unit_of_the_import_is_named_with_the_right_one(said, tmp_path):
    bag = drive(RPM).write(tmp_path / "drive")
    run, _ = imported(tmp_path / "run", bag, wheels__unit=said)
    finding = check_recording(run).findings[0]
    assert finding.name == "tread_unit"
    assert f"imported as {said}, and they fit as rpm" in finding.cause
    assert finding.remedy == "Import the bag again with --unit rpm"


def test_the_right_unit_is_left_alone(tmp_path):
    run, _ = imported(tmp_path / "run", drive(RPM).write(tmp_path / "drive"), wheels__unit="rpm")
    assert run.settings["source"]["wheel_unit"] == "rpm"
    assert "tread_unit" not in {one.name for one in check_recording(run).findings}


def test_speeds_that_no_robot_has_ask_for_the_unit(tmp_path):
    bag = drive(1e3).write(tmp_path / "drive")
    with pytest.raises(BagError, match=r"above 50 m/s are left out; is the unit \(m/s\) right"):
        imported(tmp_path / "run", bag, wheels__unit="m/s")


def test_a_key_that_is_a_table_says_so(tmp_path):
    (tmp_path / "map.toml").write_text("wheels = 3\n")
    with pytest.raises(BagError, match=r"wheels = 3, expected a table \[wheels\] with keys such"):
        read_topic_map(tmp_path / "map.toml")


def test_an_archive_is_to_be_unpacked(tmp_path):
    with zipfile.ZipFile(tmp_path / "drive.zip", "w") as packed:
        packed.writestr("drive.bag", "#ROSBAG V2.0\n")
    with pytest.raises(BagError, match=r"this is an archive \(zip\): unpack it"):
        looked_at(tmp_path / "drive.zip")


def test_a_bag_of_poses_alone_says_what_a_run_needs(tmp_path):
    """As those that a SLAM leaves; what is named all the same is refused."""
    bag = Bag("ros1")
    for t_s, _, _, x, y, yaw in course(2.0):
        bag.pose_stamped("/slam", t_s, bag.pose((x, y, 0), half_turn(yaw)))
    path = bag.write(tmp_path / "drive.bag")
    with pytest.raises(BagError, match="the bag has no wheel speeds, which a run needs"):
        imported(tmp_path / "run", path)
    with pytest.raises(BagError, match="/slam: a geometry_msgs/msg/PoseStamped holds no speeds of"):
        imported(tmp_path / "run", path, wheels__topic="/slam")
