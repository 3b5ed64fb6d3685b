"""A gyroscope whose bias wanders, headings of poses that do, and what is neither."""

from dataclasses import replace

import numpy as np
import pytest

from odometry.checks.findings.finding import Level
from odometry.checks.recording import check_recording
from odometry.geometry.se3 import rotation_from_roll_pitch_yaw
from tests.odometry.checks.drives import drive, winding
from tests.odometry.checks.faulty import gyroscope, put, treads
from tests.odometry.checks.test_other_robots import turning_much

BIASES = {
    "a minute and a half": lambda at_s: 0.02 * np.sin(at_s / 15),
    "warming up": lambda at_s: 0.04 * at_s / 120,
}


def named(run):
    return {finding.name: finding for finding in check_recording(run).findings}


def turned_map(run, rate_rad_s):
    """Positions and yaw that turn together by a rate (M,), as of SLAM without loops."""
    angle = np.append(0.0, np.cumsum(rate_rad_s[:-1] * np.diff(run.pose["t"])))
    steps = np.diff(run.pose["x"] + 1j * run.pose["y"]) * np.exp(1j * angle[1:])
    way = np.append(0.0, np.cumsum(steps))
    return put(run, "pose", x=way.real, y=way.imag, yaw=run.pose["yaw"] + angle)


@pytest.mark.parametrize("bias", BIASES.values(), ids=BIASES)
def test_a_gyroscope_that_wanders_alone_is_named_and_has_no_constant_bias(bias):
    run = winding()
    found = named(gyroscope(run, lambda rate: rate + bias(run.odometry["t"])))
    assert set(found) == {"headings_wander"}
    finding = found["headings_wander"]
    assert finding.level is Level.NOTE
    assert finding.cause.startswith("The bias of the gyroscope wanders")
    assert "the treads turn as the poses do" in finding.seen


def test_a_gyroscope_that_wanders_far_is_a_warning_and_no_disagreement():
    run = drive(*turning_much())
    wanders = gyroscope(run, lambda rate: rate + 0.06 * np.sin(run.odometry["t"] / 8))
    (found,) = check_recording(wanders).at(Level.WARNING)
    assert found.name == "headings_wander"
    assert found.cause.startswith("The bias of the gyroscope wanders")


def far_off():
    run = drive(*turning_much())
    return gyroscope(run, lambda rate: rate + 0.06 * np.sin(run.odometry["t"] / 8))


def test_it_is_judged_where_a_cell_of_the_gyroscope_is_empty():
    run = far_off()
    rates = run.odometry["gyro_z"].copy()
    rates[1000] = np.nan
    warned = check_recording(put(run, "odometry", gyro_z=rates)).at(Level.WARNING)
    assert [finding.name for finding in warned] == ["headings_wander"]


@pytest.mark.parametrize("imu_rad", [(np.pi, 0.0, 0.0), (0.0, np.pi / 2, 0.3), (0.0, 0.0, 1.0)])
def test_it_is_undone_in_the_axes_of_an_imu_as_it_is_mounted(imu_rad):
    run = far_off()
    z_of_robot = rotation_from_roll_pitch_yaw(np.array(imu_rad))[2]
    rates = run.odometry["gyro_z"][:, None] * z_of_robot
    t = run.odometry.stamps_s
    columns = {"t": t, **dict(zip(("gyro_x", "gyro_y", "gyro_z"), rates.T, strict=True))}
    kept = {n: c for n, c in run.odometry.columns.items() if n != "gyro_z"}
    mounted = replace(
        run,
        settings={**run.settings, "sensors": {"imu": list(imu_rad)}},
        imu=replace(run.odometry, columns=columns),
        odometry=replace(run.odometry, columns=kept),
    )
    (found,) = check_recording(mounted).at(Level.WARNING)
    assert found.name == "headings_wander"
    assert "headings_wander" not in named(found.mend(mounted))


def test_a_map_that_turns_is_named_where_the_treads_turn_as_the_gyroscope():
    run = winding()
    found = named(turned_map(run, 0.02 * np.sin(run.pose["t"] / 15)))["headings_wander"]
    assert found.cause.startswith("The heading of the poses drifts")


def test_treads_that_slip_do_not_tell_which_of_both():
    run, rng = winding(), np.random.default_rng(6)
    wanders = gyroscope(run, lambda rate: rate + 0.02 * np.sin(run.odometry["t"] / 15))
    slow = np.repeat(rng.standard_normal(60), len(run.odometry) // 60)
    slips = treads(wanders, lambda left, right: (left - 0.03 * slow, right + 0.03 * slow))
    cause = named(slips)["headings_wander"].cause
    assert cause.startswith("Either the bias of the gyroscope wanders")
    assert "or the heading of the poses drifts" in cause


def test_a_gyroscope_and_a_map_that_wander_together_are_no_fact():
    """By the treads the gyroscope wanders twice as much as against the poses."""
    run = winding()
    wanders = gyroscope(run, lambda rate: rate + 0.03 * np.sin(run.odometry["t"] / 15))
    both = turned_map(wanders, 0.015 * np.sin(run.pose["t"] / 15))
    assert named(both)["headings_wander"].cause.startswith("Either")


def test_a_wander_of_less_than_a_hundredth_is_none_though_it_is_certain():
    at_s = 0.05 * np.arange(4800)
    turns = np.where(at_s % 20 < 10, 0.3, -0.2) * (at_s % 10 < 4)
    run = drive(np.full(4800, 0.8), turns, yaw_sigma=0.002)
    wanders = gyroscope(run, lambda rate: rate + 0.0045 * np.sin(run.odometry["t"] / 25))
    assert "headings_wander" not in named(wanders)


def test_little_and_constant_biases_and_noise_are_none():
    run, rng = winding(), np.random.default_rng(4)
    at_s = run.odometry["t"]
    for rate in (
        0.002 * np.sin(at_s / 15),
        np.full_like(at_s, 0.02),
        0.05 * rng.standard_normal(len(at_s)),
    ):
        changed = gyroscope(run, lambda gyro, rate=rate: gyro + rate)
        assert "headings_wander" not in named(changed)


def test_a_scale_to_one_side_in_circles_of_forty_seconds_is_no_bias():
    sides = np.repeat([0.5, 0.0, -0.5, 0.0, 0.5, 0.0], 800)
    run = drive(np.full(4800, 0.8), sides)
    more = gyroscope(run, lambda rate: np.where(rate > 0, 1.06, 1.0) * rate)
    assert "headings_wander" not in named(more)


def test_without_a_yaw_nothing_is_compared():
    run = winding()
    wanders = gyroscope(run, lambda rate: rate + 0.02 * np.sin(run.odometry["t"] / 15))
    yaw = np.full(len(run.pose), np.nan)
    columns = {**run.pose.columns, "yaw": yaw}
    blind = replace(wanders, pose=replace(wanders.pose, columns=columns))
    assert "headings_wander" not in named(blind)
