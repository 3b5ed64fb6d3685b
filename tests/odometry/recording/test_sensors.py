"""Where sensors sit, and which yaw rate is preferred."""

import numpy as np
import pytest
from scipy.spatial.transform import Rotation

from odometry.errors import RunFolderError
from odometry.recording.run import Run
from odometry.recording.sensors import YawRate, gyroscope_of

ROBOT = "[robot]\ntrack_width = 0.4\n"
ODOMETRY = "t,v_left,v_right,gyro_z\n0,0.5,0.5,0.1\n0.1,0.4,0.6,\n0.2,0.4,0.6,0.3\n"


def test_a_run_without_the_table_states_nothing(make_run):
    sensors = Run.read(make_run()).sensors
    assert sensors.pose_m is None
    assert sensors.imu_rad is None


def test_what_the_table_states_is_kept(make_run):
    run = Run.read(make_run(ROBOT + "[sensors]\npose = [0.3, 0, 1]\nimu = [0, -0.1, 1.5]\nx = 1\n"))
    assert run.sensors.pose_m == (0.3, 0.0, 1.0)
    assert run.sensors.imu_rad == (0.0, -0.1, 1.5)
    assert run.settings["sensors"] == {"pose": [0.3, 0, 1], "imu": [0, -0.1, 1.5], "x": 1}


@pytest.mark.parametrize(
    "table",
    [
        "sensors = 3",
        "[sensors]\npose = 3",
        "[sensors]\npose = [1, 2]",
        "[sensors]\npose = [1, 2, nan]",
        "[sensors]\npose = [1, 2, inf]",
        "[sensors]\npose = [1, 2, true]",
        "[sensors]\npose = [1, 2, 300.0]",
        "[sensors]\nimu = [0, 0, '1']",
        "[sensors]\nimu = [0, 0, 90]",
    ],
)
def test_what_is_no_three_finite_numbers_is_refused(make_run, table):
    top, below = (table + "\n", "") if table.startswith("sensors") else ("", table)
    with pytest.raises(RunFolderError, match=r"run\.toml: .*sensors.*expected"):
        Run.read(make_run(top + ROBOT + below))


def test_without_a_gyroscope_there_is_no_yaw_rate(make_run):
    assert Run.read(make_run()).yaw_rate is None
    assert Run.read(make_run(imu="t,accel_z\n0,9.8\n")).yaw_rate is None
    empty = make_run(odometry="t,v_left,v_right,gyro_z\n0,1,1,\n", imu="t,gyro_z\n0,\n")
    assert Run.read(empty).yaw_rate is None


def test_the_gyroscope_of_odometry_without_what_was_not_measured(make_run):
    stamps_s, rates, file, odometry_s = Run.read(make_run(odometry=ODOMETRY)).yaw_rate
    assert file == "odometry.csv"
    assert (stamps_s.tolist(), rates.tolist()) == ([0.0, 0.2], [0.1, 0.3])
    assert odometry_s.tolist() == [0.0, 0.1, 0.2]


def test_that_of_imu_csv_goes_first(make_run):
    run = Run.read(make_run(odometry=ODOMETRY, imu="t,gyro_z\n0,7\n0.01,\n0.02,9\n"))
    assert run.yaw_rate.stamps_s.tolist() == [0, 0.02]
    assert run.yaw_rate.yaw_rate_rad_s.tolist() == [7, 9]
    nothing = Run.read(make_run(odometry=ODOMETRY, imu="t,gyro_z\n0,\n"))
    assert nothing.yaw_rate.yaw_rate_rad_s.tolist() == [0.1, 0.3]


@pytest.mark.parametrize("angles", [(np.pi, 0, 0), (0.2, -0.3, 1.0), (np.pi / 2, 0, 0.4)])
def test_axes_are_turned_into_those_of_the_robot(make_run, rng, angles):
    """scipy's intrinsic ZYX rotation takes the robot's rates into the sensor's axes."""
    robot = rng.normal(size=(5, 3))
    axes = Rotation.from_euler("ZYX", [angles[2], angles[1], angles[0]])
    seen = axes.inv().apply(robot)
    rows = "\n".join(f"{i},{x!r},{y!r},{z!r}" for i, (x, y, z) in enumerate(seen.tolist()))
    settings = f"{ROBOT}[sensors]\nimu = {[float(angle) for angle in angles]}\n"
    run = Run.read(make_run(settings, imu=f"t,gyro_x,gyro_y,gyro_z\n{rows}\n"))
    np.testing.assert_allclose(run.yaw_rate.yaw_rate_rad_s, robot[:, 2], rtol=0, atol=1e-12)


def test_one_axis_of_a_tilted_sensor_determines_nothing(make_run):
    """Upside down its sign is wrong: the gyroscope of odometry.csv is taken."""
    tilted = f"{ROBOT}[sensors]\nimu = [3.14159, 0, 0]\n"
    imu = "t,gyro_z\n0,-0.1\n1,-0.2\n"
    assert Run.read(make_run(tilted, imu=imu)).yaw_rate is None
    run = Run.read(make_run(tilted, odometry=ODOMETRY, imu=imu))
    assert run.yaw_rate.yaw_rate_rad_s.tolist() == [0.1, 0.3]
    turned = f"{ROBOT}[sensors]\nimu = [0, 0, 2]\n"
    assert Run.read(make_run(turned, imu=imu)).yaw_rate.yaw_rate_rad_s.tolist() == [-0.1, -0.2]


@pytest.mark.parametrize(("period_s", "seed"), [(0.5, 0), (1.0, 1), (2.0, 2)])
def test_a_slow_log_is_not_silent_from_row_to_row(period_s, seed):
    jitter_s = np.random.default_rng(seed).normal(0, 0.01, 100)
    stamps_s = np.sort(period_s * np.arange(100) + jitter_s)
    lost = np.delete(stamps_s, [50, 51])
    gyroscope = gyroscope_of(YawRate(lost, np.full(98, 0.2), "imu.csv", stamps_s))
    _, _, _, silent_s = gyroscope.between(stamps_s[:-1], stamps_s[1:])
    assert np.flatnonzero(silent_s).tolist() == [49, 50, 51]


def test_a_slow_gyroscope_beside_faster_treads_is_silent_between_its_samples():
    slow_s, rates = 2.0 * np.arange(10), np.full(10, 0.2)
    for period_s, is_silent in ((0.05, True), (0.5, True), (1.0, False), (6.0, False)):
        odometry_s = np.arange(0.0, 18.1, period_s)
        yaw_rate = YawRate(slow_s, rates, "imu.csv", odometry_s)
        silent_s = gyroscope_of(yaw_rate).between(slow_s[:-1], slow_s[1:])[3]
        assert (silent_s > 0).tolist() == [is_silent] * 9


def test_between_slow_samples_the_rate_changes_evenly():
    """Held at its mean from sample to sample, it would seem to repeat one value."""
    rates = np.array([0.0, 1.0, 3.0, 2.0])
    gyroscope = gyroscope_of(YawRate(np.arange(4.0), rates, "imu.csv", np.arange(4.0)))
    turn, gross, off, silent_s = gyroscope.between(np.array([0, 0, 1, 0]), np.array([0.5, 1, 2, 3]))
    np.testing.assert_allclose(turn, [0.125, 0.5, 2.0, 5.0])
    np.testing.assert_allclose(gross, [0.25, 0.5, 2.0, 5.0])
    np.testing.assert_allclose(off, [0.25, 0.5, 1.0, 2.0])
    assert not silent_s.any()
    steps = gyroscope.mean_rates_rad_s(np.arange(0.0, 3.01, 0.25))[1:]
    assert np.abs(np.diff(steps)).min() > 0.05
