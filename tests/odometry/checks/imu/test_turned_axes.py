"""An IMU that is mounted sideways or backwards, by its accelerations."""

from dataclasses import replace

import numpy as np
import pytest

from odometry.checks.findings.finding import Level
from odometry.checks.recording import check_recording
from odometry.tables.table import Table
from tests.odometry.checks.drives import PERIOD_S, drive
from tests.odometry.checks.faulty import without_yaw


def lively(seed=0, seconds=200):
    at_s = PERIOD_S * np.arange(int(seconds / PERIOD_S))
    speed = 0.9 + 0.35 * np.sin(at_s / 1.3) + 0.2 * np.sin(at_s / 4)
    turn = 0.4 * np.sin(at_s / 2.1) + 0.3 * np.sin(at_s / 0.9)
    return with_imu(drive(speed, turn, seed=seed), speed, turn, seed)


def with_imu(run, speed, turn, seed, place_m=(0.0, 0.0)):
    """Accelerations of the motion at a place, of a slope and of vibration, in imu.csv."""
    t, rng = run.odometry.stamps_s, np.random.default_rng(seed)
    ahead_m, left_m = place_m
    turning = np.gradient(turn, PERIOD_S)
    x = np.gradient(speed, PERIOD_S) + 0.8 * np.sin(t / 40) - ahead_m * turn**2 - left_m * turning
    y = speed * turn + 0.5 * np.cos(t / 31) - left_m * turn**2 + ahead_m * turning
    noise = 0.5 * rng.normal(size=(3, len(t)))
    columns = {"t": t, "accel_x": x + noise[0], "accel_y": y + noise[1]}
    columns["accel_z"] = 9.81 + noise[2]
    return replace(
        run, imu=Table(run.odometry.file.parent / "imu.csv", columns, run.odometry.lines)
    )


def mounted(run, degrees):
    """As an IMU reads whose axes are turned so far to the left."""
    seen = (run.imu["accel_x"] + 1j * run.imu["accel_y"]) * np.exp(-1j * np.radians(degrees))
    columns = {**run.imu.columns, "accel_x": seen.real, "accel_y": seen.imag}
    return replace(run, imu=replace(run.imu, columns=columns))


def found(run):
    return [each for each in check_recording(run).findings if each.name == "imu_axes"]


@pytest.mark.parametrize("degrees", [90, -90, 180, 135])
def test_an_imu_that_is_turned_is_noted_with_its_angle(degrees):
    (finding,) = found(mounted(lively(), degrees))
    assert finding.level is Level.NOTE
    said = float(finding.seen.split("turned by ")[1].split(" ")[0])
    assert abs((said - degrees + 180) % 360 - 180) < 10


@pytest.mark.parametrize("degrees", [0, 20])
@pytest.mark.parametrize("poses", [lambda run: run, without_yaw])
def test_an_imu_that_is_not_turned_has_no_note(degrees, poses):
    assert not found(poses(mounted(lively(), degrees)))


def test_what_is_stated_is_undone_and_a_wrong_statement_is_noted():
    def stated(run, yaw_rad):
        return replace(run, settings={"sensors": {"imu": [0.0, 0.0, yaw_rad]}})

    turned = mounted(lively(), 90)
    assert not found(stated(turned, np.pi / 2))
    (finding,) = found(stated(turned, -np.pi / 2))
    assert finding.remedy.startswith("Correct [sensors] imu")


def test_a_drive_that_is_short_or_even_says_nothing():
    assert not found(mounted(lively(seconds=40), 90))
    even = np.full(4000, 0.5)
    assert not found(mounted(with_imu(drive(even, 0 * even), even, 0 * even, 0), 90))


@pytest.mark.parametrize("radius_m", [0.6, None], ids=["arcs of one radius", "of many"])
@pytest.mark.parametrize("place_m", [(1.0, 0.0), (-1.3, 0.5), (0.0, -1.0)])
def test_an_imu_far_from_the_centre_is_not_turned(place_m, radius_m):
    at_s = PERIOD_S * np.arange(6000)
    turn = 0.4 + 0.35 * np.sin(at_s / 2.3)
    speed = 0.4 + 0.2 * np.sin(at_s / 3) if radius_m is None else radius_m * turn
    assert not found(with_imu(drive(speed, turn), speed, turn, 0, place_m))


def test_an_imu_far_from_the_centre_that_is_turned_is_noted():
    run, at_s = lively(), PERIOD_S * np.arange(4000)
    turn = 0.4 * np.sin(at_s / 2.1) + 0.3 * np.sin(at_s / 0.9)
    speed = 0.9 + 0.35 * np.sin(at_s / 1.3) + 0.2 * np.sin(at_s / 4)
    assert found(mounted(with_imu(run, speed, turn, 0, (-1.0, 0.5)), 90))


def test_noise_alone_says_nothing():
    run = lively()
    rng = np.random.default_rng(1)
    columns = {**run.imu.columns}
    columns |= {name: rng.normal(size=len(run.imu)) for name in ("accel_x", "accel_y")}
    assert not found(replace(run, imu=replace(run.imu, columns=columns)))


def test_a_reversed_gyroscope_is_no_turned_imu():
    run = lively()
    columns = {**run.odometry.columns, "gyro_z": -run.odometry["gyro_z"]}
    assert not found(replace(run, odometry=replace(run.odometry, columns=columns)))


def test_accelerations_of_odometry_are_looked_at_where_there_is_no_imu_file():
    run = mounted(lively(), 180)
    columns = {**run.odometry.columns}
    columns |= {name: run.imu[name] for name in ("accel_x", "accel_y")}
    run = replace(run, imu=None, odometry=replace(run.odometry, columns=columns))
    run = replace(run, settings={"sensors": {"imu": [0.0, 0.0, 0.0]}})  # of imu.csv
    (finding,) = found(run)
    assert finding.remedy == "Turn accel_x and accel_y to the robot's axes"
