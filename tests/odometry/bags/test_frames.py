"""Places and attitudes of sensors in the robot frame, against cases worked out by hand."""

from math import pi

import numpy as np
import pytest

from tests.odometry.bags.imports import imported
from tests.odometry.bags.made_bags import Bag, course, half_turn

# Wheels of radius 0.15 stand 0.05 above base_link, 0.02 ahead of it on the mean: base_link is
# 0.10 above the terrain, and 0.02 behind the centre of what the wheels touch.
URDF = """<?xml version="1.0"?>
<robot name="a_robot">
  <link name="base_link"/><link name="imu_link"/><link name="gps_link"/>
  <link name="camera_link"/><link name="camera_optical"/>
  {wheels}
  <joint name="imu_joint" type="fixed"><parent link="base_link"/><child link="imu_link"/>
    <origin xyz="0.1 0 0.2" rpy="3.141592653589793 0 0"/></joint>
  <joint name="gps_joint" type="fixed"><parent link="base_link"/><child link="gps_link"/>
    <origin xyz="-0.3 0.1 0.8" rpy="0 0 0"/></joint>
  <joint name="camera_joint" type="fixed"><parent link="base_link"/><child link="camera_link"/>
    <origin xyz="0.4 0 0.5" rpy="0 0.5 0"/></joint>
  <joint name="optical_joint" type="fixed">
    <parent link="camera_link"/><child link="camera_optical"/>
    <origin xyz="0 0 0" rpy="-1.5707963267948966 0 -1.5707963267948966"/></joint>
</robot>"""
WHEEL = """<link name="{name}_link"><collision><geometry>{shape}</geometry></collision></link>
  <joint name="{name}_joint" type="continuous"><parent link="base_link"/>
    <child link="{name}_link"/><origin xyz="{x} {y} 0.05" rpy="0 0 0"/></joint>"""
PLACES = {
    "front_left_wheel": (0.27, 0.3),
    "front_right_wheel": (0.27, -0.3),
    "rear_left_wheel": (-0.23, 0.3),
    "rear_right_wheel": (-0.23, -0.3),
}
MATRIX = [[50, 0, 32], [0, 50, 24], [0, 0, 1]]


def urdf(shape='<cylinder radius="0.15" length="0.1"/>'):
    wheels = (WHEEL.format(name=n, x=x, y=y, shape=shape) for n, (x, y) in PLACES.items())
    return URDF.format(wheels="\n  ".join(wheels))


def drive(kind="mcap"):
    """Wheels at 2 rad/s, an inertial sensor, fixes and a camera."""
    bag = Bag(kind)
    for t_s, *_ in course(4.0):
        bag.joints(t_s, ["left_wheel", "right_wheel"], np.zeros(2), [2.0, 2.0])
        bag.imu(t_s, (0, 0, 0), (0, 0, 9.81))
        bag.fix(t_s, 48.0, 11.0 + 1e-6 * t_s, 500.0)
    bag.image(0.5, np.zeros((48, 64), np.uint8), "mono8")
    bag.camera_info(0.0, (64, 48), MATRIX, [0.1, 0, 0, 0, 0])
    return bag


def tables(bag, tmp_path, **options):
    path = bag.write(tmp_path / ("drive.bag" if bag.kind == "ros1" else "drive"))
    run, said = imported(tmp_path / "run", path, **options)
    return run, said


@pytest.mark.parametrize("kind", ["ros1", "mcap"])
def test_a_robot_description_gives_the_robot_frame_and_all_that_is_in_it(kind, tmp_path):
    bag = drive(kind)
    bag.text("/robot_description", 0.0, urdf())
    run, said = tables(bag, tmp_path, unsized=True)
    assert run.settings["robot"] == pytest.approx(
        {"name": "a_robot", "track_width": 0.6, "wheel_radius": 0.15}
    )
    assert run.odometry["v_left"] == pytest.approx(np.full(80, 0.3))
    assert run.settings["sensors"]["pose"] == pytest.approx([-0.32, 0.1, 0.9])
    assert run.settings["sensors"]["imu"] == pytest.approx([pi, 0, 0])
    camera = run.settings["camera"]
    assert camera["mount"] == pytest.approx([0.38, 0, 0.6, 0, 0.5, 0], abs=1e-9)
    assert (camera["matrix"], camera["distortion"]) == (MATRIX, [0.1, 0, 0, 0, 0])
    assert camera["image_size"] == [64, 48]
    assert not any("not in the bag" in note for note in said.notes)


def test_wheels_of_a_mesh_have_a_track_width_and_no_radius(tmp_path):
    bag = drive()
    bag.text("/robot_description", 0.0, urdf('<mesh filename="wheel.dae"/>'))
    run, _ = tables(bag, tmp_path, robot__wheel_radius=0.15, unsized=True)
    assert run.settings["robot"]["track_width"] == pytest.approx(0.6)
    assert run.settings["camera"]["mount"][2] == pytest.approx(0.6)


def static(bag, *links):
    """Static transforms: parent, child, place, quaternion (w, x, y, z)."""
    bag.transforms("/tf_static", 0.0, [bag.transform(0.0, *link) for link in links])


OPTICAL = (0.5, -0.5, 0.5, -0.5)  # of a camera that looks ahead: rpy = (-pi/2, 0, -pi/2)


def test_base_footprint_lies_on_the_terrain(tmp_path):
    """A camera 0.2 above base_link, which is 0.13 above base_footprint."""
    bag = drive()
    static(
        bag,
        ("base_footprint", "base_link", (0, 0, 0.13), (1, 0, 0, 0)),
        ("base_link", "camera_optical", (0.3, 0, 0.2), OPTICAL),
    )
    run, _ = tables(bag, tmp_path)
    assert run.settings["camera"]["mount"] == pytest.approx([0.3, 0, 0.33, 0, 0, 0], abs=1e-9)


def test_without_the_height_of_base_link_the_camera_has_no_mount(tmp_path):
    bag = drive()
    static(bag, ("base_link", "camera_optical", (0.3, 0, 0.2), OPTICAL))
    run, said = tables(bag, tmp_path)
    assert "mount" not in run.settings["camera"]
    assert any("Add --frame-height METRES" in note for note in said.notes)


def test_a_camera_frame_that_is_no_optical_frame_looks_along_its_x_axis(tmp_path):
    """A driver that names camera_link in its images: x ahead and down by 0.5, z upwards."""
    bag = drive()
    down = (np.cos(0.25), 0, np.sin(0.25), 0)
    static(bag, ("base_footprint", "camera_optical", (0.4, 0.1, 0.6), down))
    run, said = tables(bag, tmp_path)
    assert run.settings["camera"]["mount"] == pytest.approx([0.4, 0.1, 0.6, 0, 0.5, 0], abs=1e-9)
    assert any("its x axis is taken as the viewing direction" in note for note in said.notes)


def test_the_height_of_base_link_may_be_given(tmp_path):
    bag = drive()
    static(bag, ("base_link", "camera_optical", (0.3, 0, 0.2), OPTICAL))
    run, _ = tables(bag, tmp_path, robot__frame_height=0.13)
    assert run.settings["camera"]["mount"][2] == pytest.approx(0.33)


def test_frames_of_a_namespace_and_slashes_of_old_drivers_are_found(tmp_path):
    bag = drive()
    static(
        bag,
        ("/husky/base_link", "/husky/plate", (0, 0, 0.1), half_turn(pi / 2)),
        ("husky/plate", "gps_link", (0.5, 0, 0), (1, 0, 0, 0)),
    )
    run, _ = tables(bag, tmp_path)
    assert run.settings["sensors"]["pose"] == pytest.approx([0, 0.5, 0.1])


def test_the_attitude_of_a_turned_tracker_is_turned_back(tmp_path):
    """A tracker whose x axis points left sees a robot that faces north as facing west."""
    bag = Bag("mcap")
    for t_s, *_ in course(4.0):
        bag.joints(t_s, ["left_wheel", "right_wheel"], np.zeros(2), [2.0, 2.0])
        pose = bag.pose((1, 2, 0), half_turn(pi))
        bag.odometry("/slam", t_s, pose, bag.twist(0, 0), world="map", child="tracker")
    static(bag, ("base_link", "tracker", (0.2, 0, 0.4), half_turn(pi / 2)))
    run, _ = tables(bag, tmp_path)
    assert run.pose["yaw"] == pytest.approx(np.full(80, pi / 2))
    assert (run.pose["x"][0], run.pose["y"][0]) == (1, 2)
    assert run.settings["sensors"]["pose"] == pytest.approx([0.2, 0, 0.4])


def test_other_odometry_is_that_of_the_robot_not_of_the_sensor(tmp_path):
    """A lidar 0.2 ahead of the robot, which faces north: the robot is 0.2 south of it."""
    bag = drive()
    pose = bag.pose((1, 2, 0), half_turn(pi / 2))
    bag.odometry("/lidar/odom", 1.0, pose, bag.twist(0, 0), child="lidar")
    static(bag, ("base_link", "lidar", (0.2, 0, 0.4), (1, 0, 0, 0)))
    run, _ = tables(bag, tmp_path, reference__topic="/gps/fix")
    rows = np.loadtxt(run.folder / "other_odometry/lidar_odom.csv", delimiter=",", skiprows=1)
    assert rows[1:] == pytest.approx([1, 1.8, pi / 2])


def test_rectified_images_have_the_matrix_of_the_projection(tmp_path):
    bag = drive()
    projection = np.array([[40, 0, 30], [0, 40, 20], [0, 0, 1]])
    bag.written = [one for one in bag.written if "camera" not in one[0]]
    bag.camera_info(0.0, (64, 48), MATRIX, [0.1, 0, 0, 0, 0], projection=projection)
    bag.image(0.5, np.zeros((48, 64), np.uint8), "mono8")
    _, kind, t_s, message = bag.written[-1]
    bag.written[-1] = ("/camera/image_rect", kind, t_s, message)
    camera = tables(bag, tmp_path)[0].settings["camera"]
    assert (camera["matrix"], camera["distortion"]) == (projection.tolist(), [])


def test_binning_halves_the_image(tmp_path):
    """The ray of pixel (u, v) of the full image goes through ((u + 0.5)/2 - 0.5, ...)."""
    bag = drive()
    bag.written = [one for one in bag.written if one[0] != "/camera/camera_info"]
    bag.camera_info(0.0, (64, 48), MATRIX, [0] * 5, binning=2)
    camera = tables(bag, tmp_path)[0].settings["camera"]
    assert camera["image_size"] == [32, 24]
    assert camera["matrix"] == [[25, 0, 15.75], [0, 25, 11.75], [0, 0, 1]]


def test_a_fisheye_model_is_not_taken_for_opencvs(tmp_path):
    bag = drive()
    bag.written = [one for one in bag.written if one[0] != "/camera/camera_info"]
    bag.camera_info(0.0, (64, 48), MATRIX, [0.1] * 4, model="equidistant")
    run, said = tables(bag, tmp_path)
    assert "camera" not in run.settings
    assert any("'equidistant'" in note for note in said.notes)
