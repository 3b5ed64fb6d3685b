"""Inertial sensors that measure turn rates or accelerations alone."""

import numpy as np
import pytest

from tests.odometry.bags.imports import imported
from tests.odometry.bags.made_bags import RADIUS_M, Bag, course

NAMES = ["left_wheel", "right_wheel"]
RATES, FORCES = (0.01, -0.02, 0.3), (0.1, 0.2, 9.81)
NOTHING = (0.0, 0.0, 0.0)


def drive(*sensors, covariance=0.0):
    """Wheels, and sensors as (topic, angular velocities, accelerations)."""
    bag = Bag("mcap")
    for t_s, left, right, *_ in course(4.0):
        bag.joints(t_s, NAMES, [], np.array([left, right]) / RADIUS_M)
        for topic, rates, forces in sensors:
            bag.imu(t_s, rates, forces)
            _, kind, _, message = bag.written[-1]
            message.linear_acceleration_covariance[0] = covariance
            bag.written[-1] = (topic, kind, t_s, message)
    return bag


def test_of_a_camera_the_topic_of_its_gyroscope_is_taken(tmp_path):
    """Its names would put the one of the accelerations, whose rates are zero, first."""
    bag = drive(("/camera/accel/sample", NOTHING, FORCES), ("/camera/gyro/sample", RATES, NOTHING))
    run, said = imported(tmp_path / "run", bag.write(tmp_path / "bag"))
    assert run.imu["gyro_z"] == pytest.approx(RATES[2])
    assert "accel_z" not in run.imu
    assert any(
        note.startswith("imu: /camera/gyro/sample: accelerations are left out")
        for note in said.notes
    )


def test_accelerations_alone_are_taken_without_rates_of_zero(tmp_path):
    bag = drive(("/imu/data", NOTHING, FORCES))
    run, said = imported(tmp_path / "run", bag.write(tmp_path / "bag"))
    assert set(run.imu.columns) >= {"accel_x", "accel_y", "accel_z"}
    assert "gyro_z" not in run.imu
    assert any("angular velocities are left out" in note for note in said.notes)


def test_what_is_said_not_to_be_measured_is_left_out_and_named(tmp_path):
    """REP-145: a covariance that begins with -1."""
    bag = drive(("/imu/data", RATES, FORCES), covariance=-1.0)
    run, said = imported(tmp_path / "run", bag.write(tmp_path / "bag"))
    assert "accel_z" not in run.imu
    assert any("accelerations are left out" in note for note in said.notes)


def test_a_first_message_that_measures_nothing_takes_nothing_from_the_others(tmp_path):
    """A driver that says so until its sensor has started."""
    bag = drive(("/imu/data", RATES, FORCES))
    first = next(message for topic, _, _, message in bag.written if topic == "/imu/data")
    first.angular_velocity_covariance[0] = -1
    run, said = imported(tmp_path / "run", bag.write(tmp_path / "bag"))
    assert run.imu["gyro_z"][1:] == pytest.approx(RATES[2])
    assert not any("left out" in note for note in said.notes)


def test_of_two_sensors_on_a_topic_the_one_of_most_messages_is_taken(tmp_path):
    """One is mounted upside down: their mean is no turn at all."""
    bag = Bag("mcap")
    for k, (t_s, left, right, *_) in enumerate(course(4.0)):
        bag.joints(t_s, NAMES, [], np.array([left, right]) / RADIUS_M)
        if k % 2 == 0:
            bag.imu(t_s, -np.array(RATES), FORCES, "other_imu")
        bag.imu(t_s + 0.01, RATES, FORCES, "imu_link")
    path = bag.write(tmp_path / "bag")
    run, said = imported(tmp_path / "run", path)
    assert run.imu["gyro_z"] == pytest.approx(RATES[2])
    assert any("40 messages dropped: of other_imu, another inertial" in of for of in said.losses)
    run, _ = imported(tmp_path / "other", path, imu__frame="other_imu")
    assert run.imu["gyro_z"] == pytest.approx(-RATES[2])


@pytest.mark.parametrize(("unstamped", "by_header"), [(0, True), (1, True), (40, False)])
def test_header_stamps_of_a_part_of_the_messages_are_not_mixed_with_reception(
    unstamped, by_header, tmp_path
):
    """Header stamps lie 0.4 s before reception; zeros have to mean that there is none."""
    bag = drive()
    for k, (_, _, t_s, message) in enumerate(bag.written):
        message.header.stamp = bag.time(t_s - 0.4)
        if k < unstamped:
            message.header.stamp = bag.message("builtin_interfaces/msg/Time", sec=0, nanosec=0)
    run, said = imported(tmp_path / "run", bag.write(tmp_path / "bag"))
    assert run.settings["source"]["time"] == ("header" if by_header else "log")
    assert np.diff(run.odometry.stamps_s)[1:] == pytest.approx(0.05, abs=1e-6)
    assert any("have header stamps in part only" in note for note in said.notes) != by_header
