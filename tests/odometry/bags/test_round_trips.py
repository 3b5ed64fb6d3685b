"""What is written to a bag of any kind comes back in the run folder."""

import cv2
import numpy as np
import pytest

from odometry.errors import BagError
from tests.odometry.bags.imports import imported
from tests.odometry.bags.made_bags import (
    BEGIN_NS,
    KINDS,
    RADIUS_M,
    TRACK_M,
    Bag,
    course,
    half_turn,
    name_of,
)

JOINTS = ["front_left_wheel", "front_right_wheel", "rear_left_wheel", "rear_right_wheel"]
COURSE = np.array(list(course(8.0)))


def drive(kind):
    bag = Bag(kind)
    for t_s, left, right, x, y, yaw in COURSE:
        speeds = [left / RADIUS_M, right / RADIUS_M] * 2
        bag.joints(t_s, JOINTS, np.zeros(4), speeds)
        bag.imu(t_s + 0.001, (0.1, 0.2, t_s), (0.3, 0.4, 9.8))
        bag.pose_stamped("/mocap/pose", t_s + 0.002, bag.pose((x, y, 0.5), half_turn(yaw)))
        pose = bag.pose((x, -y, 0), half_turn(-yaw))
        bag.odometry("/odom", t_s + 0.003, pose, bag.twist(1.0, 2.0))
    return bag


def jpeg(grey):
    return cv2.imencode(".jpg", np.full((24, 32, 3), grey, np.uint8))[1].tobytes()


@pytest.mark.parametrize("kind", KINDS)
def test_every_kind_of_bag_gives_the_same_run(kind, tmp_path):
    bag = drive(kind)
    photos = [jpeg(40 + number) for number in range(8)]
    for number, photo in enumerate(photos):
        bag.compressed(number + 0.5, photo)
    run, said = imported(tmp_path / "run", bag.write(tmp_path / name_of(kind)))
    assert said.losses == ()
    stamps_s = BEGIN_NS / 1e9 + COURSE[:, 0]
    assert run.odometry["t"] == pytest.approx(stamps_s, abs=1e-6)
    assert run.odometry.stack("v_left", "v_right") == pytest.approx(COURSE[:, 1:3], abs=1e-8)
    assert run.imu["gyro_z"] == pytest.approx(COURSE[:, 0], abs=1e-8)
    assert run.imu["accel_y"] == pytest.approx(np.full(len(COURSE), 0.4))
    assert run.pose.stack("x", "y", "yaw") == pytest.approx(COURSE[:, 3:6], abs=1e-8)
    assert run.pose["z"] == pytest.approx(np.full(len(COURSE), 0.5))
    other = np.loadtxt(tmp_path / "run/other_odometry/odom.csv", delimiter=",", skiprows=1)
    assert other[:, 1:] == pytest.approx(COURSE[:, 3:6] * [1, -1, -1], abs=1e-8)
    assert [(run.folder / name).read_bytes() for name in run.images["file"]] == photos


@pytest.mark.parametrize("kind", ["ros1", "sqlite3", "mcap"])
def test_split_files_are_one_recording_in_any_order(kind, tmp_path):
    bag = drive(kind)
    halves = [
        bag.write(tmp_path / f"{name}_{name_of(kind)}", only)
        for name, only in (("b", lambda t: t < 4), ("a", lambda t: t >= 4))
    ]
    run, said = imported(tmp_path / "run", *reversed(halves))
    assert said.losses == ()
    assert run.odometry["v_left"] == pytest.approx(COURSE[:, 1], abs=1e-8)
    assert run.pose["x"] == pytest.approx(COURSE[:, 3], abs=1e-8)


def test_long_parts_in_any_order_lose_nothing(tmp_path):
    """More rows a part than are held back to be sorted."""
    bag = Bag("mcap")
    for number in range(3000):
        bag.joints(number / 100, ["left_wheel", "right_wheel"], np.zeros(2), [1.0, 2.0])
    parts = [
        bag.write(tmp_path / name, only)
        for name, only in (("late", lambda t: t >= 15), ("early", lambda t: t < 15))
    ]
    run, said = imported(tmp_path / "run", *parts)
    assert said.losses == ()
    assert len(run.odometry) == 3000


def test_a_folder_of_many_files_without_metadata_is_read_in_the_order_of_its_stamps(tmp_path):
    bag, folder = drive("mcap"), tmp_path / "split"
    folder.mkdir()
    for part in range(12):
        made = bag.write(tmp_path / f"part{part}", lambda t, p=part: int(t * 1.5) == p)
        (made / f"part{part}.mcap").rename(folder / f"split_{part}.mcap")
    run, said = imported(tmp_path / "run", folder)
    assert said.losses == ()
    assert run.odometry["v_right"] == pytest.approx(COURSE[:, 2], abs=1e-8)


def test_bags_of_different_topics_at_the_same_time_are_one_recording(tmp_path):
    bag = drive("mcap")
    wheels, rest = Bag("mcap"), Bag("mcap")
    for one in bag.written:
        (wheels if one[0] == "/joint_states" else rest).written.append(one)
    paths = [wheels.write(tmp_path / "wheels"), rest.write(tmp_path / "rest")]
    run, _ = imported(tmp_path / "run", *paths)
    assert run.odometry["v_left"] == pytest.approx(COURSE[:, 1], abs=1e-8)
    assert run.pose["y"] == pytest.approx(COURSE[:, 4], abs=1e-8)


@pytest.mark.parametrize("kind", ["sqlite3", "mcap"])
def test_a_bare_file_is_read_without_its_folder(kind, tmp_path):
    folder = drive(kind).write(tmp_path / "drive")
    (file,) = (one for one in folder.iterdir() if one.suffix != ".yaml")
    run, _ = imported(tmp_path / "run", file)
    assert run.odometry["v_left"] == pytest.approx(COURSE[:, 1], abs=1e-8)


@pytest.mark.parametrize("kind", ["ros1", "mcap"])
@pytest.mark.parametrize(
    ("encoding", "channels"), [("mono8", 1), ("bgr8", 3), ("rgb8", 3), ("bgra8", 4)]
)
def test_raw_images_keep_their_pixels(kind, encoding, channels, tmp_path, rng):
    bag = drive(kind)
    shape = (24, 32) if channels == 1 else (24, 32, channels)
    pixels = rng.integers(0, 256, shape, dtype=np.uint8)
    bag.image(1.0, pixels, encoding)
    run, _ = imported(tmp_path / "run", bag.write(tmp_path / name_of(kind)))
    (name,) = run.images["file"]
    expected = (
        pixels[..., ::-1] if encoding == "rgb8" else pixels[..., :3] if channels > 1 else pixels
    )
    seen = cv2.imread(str(run.folder / name), cv2.IMREAD_UNCHANGED)
    assert np.array_equal(seen, expected)


def test_satellite_fixes_are_metres_from_the_first(tmp_path):
    """A degree of latitude at the equator of WGS 84 is 110574 m, one of longitude 111320 m."""
    bag = drive("mcap")
    bag.written = [one for one in bag.written if one[0] != "/mocap/pose"]
    places = [(0.0, 0.0), (0.0, 0.001), (0.001, 0.0)]
    for number, (latitude, longitude) in enumerate(places):
        bag.fix(number, latitude, longitude, 10.0 + number)
    bag.fix(3.5, 0.5, 0.5, 0.0, status=-1)
    run, said = imported(tmp_path / "run", bag.write(tmp_path / "drive"))
    assert run.pose["x"] == pytest.approx([0, 111.320, 0], abs=0.001)
    assert run.pose["y"] == pytest.approx([0, 0, 110.574], abs=0.001)
    assert np.isnan(run.pose["yaw"]).all()
    assert run.settings["source"]["origin"] == {"latitude": 0, "longitude": 0, "altitude": 10}
    assert any("1 messages dropped: no fix" in line for line in said.losses)


def test_a_transform_of_a_motion_capture_system_is_a_reference(tmp_path):
    bag = drive("mcap")
    bag.written = [one for one in bag.written if one[0] != "/mocap/pose"]
    for t_s, _, _, x, y, yaw in COURSE:
        moved = bag.transform(t_s, "world", "robot", (x, y, 0.3), half_turn(yaw))
        bag.add("/vicon/robot", "geometry_msgs/msg/TransformStamped", t_s, moved)
    run, _ = imported(tmp_path / "run", bag.write(tmp_path / "drive"))
    assert run.pose.stack("x", "y", "yaw") == pytest.approx(COURSE[:, 3:6], abs=1e-8)


def test_the_robot_on_a_map_is_located_by_transforms(tmp_path):
    """map <- odom turns by a quarter; odom <- base_link is the course: x, y = -y, x."""
    bag = drive("mcap")
    for t_s, _, _, x, y, yaw in COURSE:
        still = bag.transform(t_s, "map", "odom", (5, 0, 0), half_turn(np.pi / 2))
        moved = bag.transform(t_s, "odom", "base_link", (x, y, 0), half_turn(yaw))
        bag.transforms("/tf", t_s, [still, moved])
    bag.written = [one for one in bag.written if one[0] != "/mocap/pose"]
    path = bag.write(tmp_path / "drive")
    _, said = imported(tmp_path / "without", path)
    assert any("--reference /tf takes it" in note for note in said.notes)
    run, _ = imported(tmp_path / "run", path, reference__topic="/tf")
    assert run.pose["x"] == pytest.approx(5 - COURSE[:, 4], abs=1e-8)
    assert run.pose["y"] == pytest.approx(COURSE[:, 3], abs=1e-8)
    assert run.pose["yaw"] == pytest.approx(COURSE[:, 5] + np.pi / 2, abs=1e-8)


def test_a_frame_of_the_world_that_is_not_there_is_asked_for(tmp_path):
    bag = drive("mcap")
    moved = bag.transform(0.0, "odom", "base_link", (1, 0, 0), half_turn(0))
    bag.transforms("/tf", 0.0, [moved])
    path = bag.write(tmp_path / "drive")
    with pytest.raises(BagError, match=r"no frame 'map'.*found: base_link, odom"):
        imported(tmp_path / "run", path, reference__topic="/tf")


def test_the_prism_of_a_total_station_has_positions_and_no_heading(tmp_path):
    bag = drive("mcap")
    bag.written = [one for one in bag.written if one[0] != "/mocap/pose"]
    for t_s, _, _, x, y, _ in COURSE:
        point = bag.vector(x, y, 1.5, name="Point")
        kind = "geometry_msgs/msg/PointStamped"
        bag.add("/prism", kind, t_s, bag.message(kind, header=bag.header(t_s, "w"), point=point))
    run, _ = imported(tmp_path / "run", bag.write(tmp_path / "drive"))
    assert run.pose.stack("x", "y") == pytest.approx(COURSE[:, 3:5], abs=1e-8)
    assert np.isnan(run.pose["yaw"]).all()


def test_topics_whose_names_are_alike_have_files_of_their_own(tmp_path):
    bag = drive("mcap")
    for name in ("/a/odom", "/a_odom"):
        bag.odometry(name, 1.0, bag.pose((1, 0, 0), half_turn(0)), bag.twist(0, 0))
    _, said = imported(tmp_path / "run", bag.write(tmp_path / "drive"))
    assert said.rows["other_odometry/a_odom.csv"] == (1, "/a/odom")
    assert said.rows["other_odometry/a_odom_2.csv"] == (1, "/a_odom")


def test_other_odometry_is_named_after_its_topic_and_odometry_may_be_left_out(tmp_path):
    run, said = imported(tmp_path / "run", drive("mcap").write(tmp_path / "drive"))
    assert said.rows["other_odometry/odom.csv"] == (len(COURSE), "/odom")
    assert run.settings["robot"]["track_width"] == TRACK_M
