"""Whole turns of a simulated robot that turns up to 3 rad/s, at few and lost poses."""

from dataclasses import replace

import numpy as np
import pytest

from odometry.windows.config import WindowConfig
from odometry.windows.recorded.record import UNKNOWN_TURNS
from odometry.windows.recorded.turns import continuous_yaw, counted_turns
from odometry.windows.travel.windows import windows_of
from tests.odometry.windows.turning_robot import turning_run

SEEDS = range(4)


def counted(run, true_yaw):
    """Wrong and unknown counts, and those that the nearest yaw gets wrong; of how many."""
    found = counted_turns(run, run.pose.stamps_s, run.pose["yaw"])
    wrong = np.abs(np.diff(found.yaw_rad) - np.diff(true_yaw)) > 1
    nearest = np.abs(np.diff(np.unwrap(run.pose["yaw"])) - np.diff(true_yaw)) > 1
    return np.array([(wrong & found.known).sum(), (~found.known).sum(), nearest.sum(), len(wrong)])


def counted_over_seeds(rate_hz, dropped, bias_rad_s, change=lambda run: run, **settings):
    drawn = (
        turning_run(seed, rate_hz, dropped, bias_rad_s=bias_rad_s, **settings) for seed in SEEDS
    )
    return sum(counted(change(run), true) for run, true in drawn)


def gyroscope(factor, added=0.0):
    def change(run):
        columns = {**run.odometry.columns, "gyro_z": factor * run.odometry["gyro_z"] + added}
        return replace(run, odometry=replace(run.odometry, columns=columns))

    return change


def treads(factor):
    def change(run):
        speeds = {name: factor * run.odometry[name] for name in ("v_left", "v_right")}
        return replace(run, odometry=replace(run.odometry, columns=run.odometry.columns | speeds))

    return change


@pytest.mark.parametrize("dropped", [0.0, 0.3, 0.6])
@pytest.mark.parametrize("rate_hz", [0.5, 1, 2, 10])
@pytest.mark.parametrize("bias_rad_s", [0.0, 0.02, -0.05, None])
def test_no_count_is_wrong(rate_hz, dropped, bias_rad_s):
    wrong, unknown, nearest, pairs = counted_over_seeds(rate_hz, dropped, bias_rad_s)
    assert wrong == 0
    if rate_hz < 1 or (rate_hz < 10 and dropped > 0):
        assert nearest > 0.01 * pairs  # as it was counted before
    if rate_hz > 0.5 and bias_rad_s is not None:
        assert unknown < 0.05 * pairs
    if rate_hz >= 1 and dropped <= 0.3:
        assert unknown < 0.02 * pairs


@pytest.mark.parametrize("bias_rad_s", [0.02, -0.02])
def test_over_a_long_gap_of_poses_a_bias_cannot_make_a_count_wrong(bias_rad_s):
    """40 s without a pose: 0.02 rad/s are 0.8 rad; the bias is known, or nothing is said."""
    run, true_yaw = turning_run(1, 2, 0.0, bias_rad_s=bias_rad_s)
    kept = (run.pose.stamps_s < 30.0) | (run.pose.stamps_s > 70.0)
    pose = replace(run.pose, columns={name: c[kept] for name, c in run.pose.columns.items()})
    wrong, *_ = counted(replace(run, pose=pose), true_yaw[kept])
    assert wrong == 0
    kept = (run.pose.stamps_s < 2.0) | (run.pose.stamps_s > 118.0)
    pose = replace(run.pose, columns={name: c[kept] for name, c in run.pose.columns.items()})
    wrong, unknown, *_ = counted(replace(run, pose=pose), true_yaw[kept])
    assert wrong == 0
    assert unknown > 0


@pytest.mark.parametrize("bias_rad_s", [0.02, -0.3])
def test_a_gyroscope_whose_bias_is_known_counts_over_a_long_gap_of_poses(bias_rad_s):
    run, true_yaw = turning_run(1, 10, 0.0, bias_rad_s=bias_rad_s, fastest_rad_s=1.0)
    kept = (run.pose.stamps_s < 40.0) | (run.pose.stamps_s > 75.0)
    pose = replace(run.pose, columns={name: c[kept] for name, c in run.pose.columns.items()})
    wrong, unknown, *_ = counted(replace(run, pose=pose), true_yaw[kept])
    assert (wrong, unknown) == (0, 0)


@pytest.mark.parametrize(
    "change",
    [
        gyroscope(np.degrees(1.0)),
        gyroscope(-1.0),
        gyroscope(0.5),
        gyroscope(1.1),
        gyroscope(1.0, 0.5),
        gyroscope(0.0),
        gyroscope(0.0, 0.3),
        treads(-1.0),
        treads(3.0),
        treads(1 / 3),
    ],
    ids=[
        "degrees", "reversed", "half", "scale", "bias", "silent", "frozen", "treads reversed",
        "treads fast", "treads slow",
    ],
)  # fmt: skip
@pytest.mark.parametrize("rate_hz", [0.5, 2])
def test_a_sensor_that_is_wrong_makes_no_count_wrong(change, rate_hz):
    wrong, *_ = counted_over_seeds(rate_hz, 0.4, 0.02, change)
    assert wrong == 0


def test_the_gyroscope_of_imu_csv_is_preferred():
    """That of odometry.csv is silent here."""
    run, true_yaw = turning_run(3, 0.5, 0.0, bias_rad_s=0.0)
    imu = replace(run.odometry, columns={name: run.odometry[name] for name in ("t", "gyro_z")})
    without = replace(gyroscope(0.0)(run), imu=imu)
    np.testing.assert_array_equal(counted(without, true_yaw), counted(run, true_yaw))
    assert counted(without, true_yaw)[1] == 0


def test_continuous_yaw_is_the_measured_one_but_for_whole_turns():
    run, true_yaw = turning_run(2, 1, 0.3, bias_rad_s=0.01)
    yaw = run.pose["yaw"].copy()
    yaw[[5, 6, 20]] = np.nan
    found = continuous_yaw(
        replace(run, pose=replace(run.pose, columns={**run.pose.columns, "yaw": yaw}))
    )
    np.testing.assert_array_equal(np.isnan(found), np.isnan(yaw))
    told = ~np.isnan(yaw)
    np.testing.assert_allclose(found[told], (true_yaw - true_yaw[0] + yaw[0])[told], atol=1e-9)


@pytest.mark.parametrize("bias_rad_s", [0.02, None])
def test_windows_measure_the_true_turn(bias_rad_s):
    """At 1 Hz with a third of the poses lost; by the nearest yaw every sixth would be wrong."""
    wrong, windows_count, left_out = 0, 0, 0
    for seed in SEEDS:
        run, true_yaw = turning_run(seed, 1, 0.35, bias_rad_s=bias_rad_s)
        windows = windows_of([run], WindowConfig(pose_gap_s=10.0))
        turned = true_yaw[windows.last_pose] - true_yaw[windows.first_pose]
        wrong += np.count_nonzero(np.abs(windows.measured[:, 2] - turned) > 0.1)
        windows_count += len(windows)
        left_out += windows.left_out[UNKNOWN_TURNS]
    assert wrong == 0
    assert windows_count > 100
    assert left_out < 0.1 * windows_count


@pytest.mark.parametrize("bias_rad_s", [0.0, 0.02, -0.03])
def test_rare_poses_are_counted_by_a_gyroscope_that_agrees_with_them(bias_rad_s):
    """8 s between poses: too long for a bias that is not known, but they agree with it."""
    run, true_yaw = turning_run(5, 0.5, 0.0, bias_rad_s=bias_rad_s)
    rare = slice(None, None, 4)
    columns = {name: values[rare] for name, values in run.pose.columns.items()}
    few = replace(run, pose=replace(run.pose, columns=columns))
    wrong, unknown, nearest, pairs = counted(few, true_yaw[rare])
    assert wrong == 0
    assert nearest > 0.3 * pairs
    assert unknown < 0.2 * pairs
