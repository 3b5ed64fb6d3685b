"""Roll and pitch of odometry.csv from the orientation of Imu messages, against a known attitude."""

import numpy as np
import pytest

from odometry.geometry import se3
from tests.odometry.bags.imports import imported
from tests.odometry.bags.made_bags import Bag, course
from tests.odometry.bags.test_frames import urdf

UPSIDE_DOWN = se3.rotation_from_roll_pitch_yaw(np.array([np.pi, 0.0, 0.0]))  # of imu_link
GRAVITY = np.array([0.0, 0.0, 9.81])


def attitude(t_s):
    """Roll, pitch and yaw of the robot, slow enough for straight lines between 50 Hz."""
    return np.array([0.2 * np.sin(0.3 * t_s), -0.1 + 0.1 * np.cos(0.2 * t_s), 0.3 * t_s])


def sloping_drive(world=(0.0, 0.0, 0.0), turn=attitude, covariance=0.0):
    """Wheels, and a sensor mounted upside down whose world is turned by `world`."""
    world = se3.rotation_from_roll_pitch_yaw(np.array(world))
    bag = Bag("mcap")
    bag.text("/robot_description", 0.0, urdf())
    for t_s, *_ in course(20.0):
        bag.joints(t_s, ["left_wheel", "right_wheel"], np.zeros(2), [2.0, 2.0])
    for t_s in np.arange(1.003, 19.0, 0.02):
        robot = se3.rotation_from_roll_pitch_yaw(turn(t_s))
        imu = robot @ UPSIDE_DOWN
        wxyz = se3.quaternion_wxyz(world @ imu)
        bag.imu(t_s, (0, 0, 0.1), imu.T @ GRAVITY, wxyz=wxyz, covariance=covariance)
    return bag


def test_the_orientation_of_a_turned_sensor_gives_roll_and_pitch_of_the_robot(tmp_path):
    run, said = imported(tmp_path / "run", sloping_drive().write(tmp_path / "drive"))
    t_s = run.odometry.stamps_s - run.odometry.stamps_s[0]
    within = (t_s > 1.003) & (t_s < 18.98)
    true = np.array([attitude(each) for each in t_s])
    for number, name in enumerate(("roll", "pitch")):
        assert run.odometry[name][within] == pytest.approx(true[within, number], abs=1e-4)
        assert np.isnan(run.odometry[name][~within]).all()
    assert "odometry.csv: roll and pitch from the orientation of /imu/data" in said.notes
    assert set(run.imu.columns) - {"t"} == {
        *("gyro_x", "gyro_y", "gyro_z", "accel_x", "accel_y", "accel_z")
    }


def test_wheels_in_a_file_before_that_of_the_sensor_get_its_attitude(tmp_path):
    """Per-sensor files are read one after the other."""
    bag = sloping_drive()
    both = bag.written
    for name, is_imu in (("wheels", False), ("imu", True)):
        bag.written = [one for one in both if one[0].startswith("/imu") == is_imu]
        bag.write(tmp_path / name)
    run, _ = imported(tmp_path / "run", tmp_path / "wheels", tmp_path / "imu")
    assert np.isfinite(run.odometry["roll"]).sum() == 359  # 1.05 to 18.95 s


@pytest.mark.parametrize(
    ("bag", "reason"),
    [
        (lambda: sloping_drive(covariance=-1.0), ""),
        (lambda: sloping_drive(world=(np.pi, 0.0, 0.0)), "tilted by 17"),
        (lambda: sloping_drive(turn=lambda _: np.zeros(3)), "it never changes"),
        (
            lambda: sloping_drive(world=(0.0, 0.5, 0.0)),
            "its vertical is 29 degrees off",
        ),
    ],
    ids=["none given", "z down", "not filled in", "against gravity"],
)
def test_an_orientation_that_is_none_of_the_robot_is_left_out_and_said(bag, reason, tmp_path):
    run, said = imported(tmp_path / "run", bag().write(tmp_path / "drive"))
    assert not {"roll", "pitch"} & set(run.odometry.columns)
    of_imu = [note for note in said.notes if "orientation" in note]
    assert [reason in note for note in of_imu] == ([True] if reason else [])


def test_accelerations_without_gravity_do_not_speak_against_an_orientation(tmp_path):
    bag = sloping_drive()
    for topic, _, _, message in bag.written:
        if topic == "/imu/data":
            message.linear_acceleration.z = message.linear_acceleration.y = 0.0
            message.linear_acceleration.x = 0.3
    run, _ = imported(tmp_path / "run", bag.write(tmp_path / "drive"))
    assert "roll" in run.odometry
