"""The gyroscope against headings: bias, scale and delay are put in, and come back or not."""

from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

from odometry.modes.recorded.heading_check import (
    EVERY_S,
    TOGETHER_S,
    WINDOW_S,
    HeadingCheck,
    heading_check,
)
from odometry.recording.run import Robot, Run
from odometry.tables.table import Table

STEP_S, SIZE = 0.02, 3000
NOISE_RAD, NOISE_RAD_S = 0.005, 0.01


def run_of(rng, *, bias_rad_s=0.0, scale=1.0, late_s=0.0, amplitude=0.6, jump_rad=0.0, from_s=0.0):
    """Weaving for a minute at 50 Hz, headings at 10 Hz; what is wrong is so from a time on."""
    t = STEP_S * np.arange(SIZE)
    omega = amplitude * np.sin(2 * np.pi * t / 7.3) + 0.3 * amplitude * np.sin(2 * np.pi * t / 2.9)
    yaw = np.append(0.0, np.cumsum((omega[1:] + omega[:-1]) / 2) * STEP_S)
    late = t >= from_s
    measured = np.where(late, scale * omega + bias_rad_s, omega) + NOISE_RAD_S * rng.normal(
        size=SIZE
    )
    seen = np.interp(np.where(late, t - late_s, t), t, yaw)[::5]
    seen = seen + NOISE_RAD * rng.normal(size=len(seen)) + jump_rad * (t[::5] >= 30.0)
    odometry = {"t": t, "v_left": 0 * t, "v_right": 0 * t, "gyro_z": measured}
    wrapped = np.angle(np.exp(1j * (seen + 3.0)))
    pose = {"t": t[::5], "x": 0 * seen, "y": 0 * seen, "yaw": wrapped}
    pose["window"] = (t[::5] >= 30.0).astype(float)
    tables = [Table(Path("t.csv"), c, np.arange(len(c["t"])) + 2) for c in (odometry, pose)]
    return Run(Path("drive"), Robot(0.5), {}, *tables)


@pytest.mark.parametrize("seed", range(5))
@pytest.mark.parametrize("late_s", [0.0, 0.08])
def test_a_bias_comes_back_within_its_deviation(seed, late_s):
    run = run_of(np.random.default_rng(seed), bias_rad_s=0.03, late_s=late_s)
    check = heading_check(run)
    off = (check.bias_rad_s - 0.03) / check.bias_sigma_rad_s
    assert np.abs(off).max() < 4.0
    assert check.bias_sigma_rad_s[check.bias_windows].max() < 0.0025
    assert not check.scale_is_off.any()


def test_headings_that_are_late_by_much_determine_no_bias():
    check = heading_check(run_of(np.random.default_rng(1), bias_rad_s=0.03, late_s=0.3))
    assert not len(check.bias_windows)
    assert not check.scale_is_off.any()


@pytest.mark.parametrize("scale", [0.7, 0.85, 1.2, 1.5])
def test_a_scale_comes_back_and_is_off_soon_after_its_onset(scale):
    run = run_of(np.random.default_rng(1), scale=scale, from_s=30.0)
    check = heading_check(run)
    whole = check.stamps_s >= 30.0 + WINDOW_S + TOGETHER_S
    np.testing.assert_allclose(check.scale[whole], scale, atol=0.05)
    assert check.scale_is_off[whole].mean() > 0.9
    assert not check.scale_is_off[check.stamps_s <= 30.0].any()
    assert not check.scale_is_right[whole].any()
    assert set(check.bias_windows.tolist()).isdisjoint(np.flatnonzero(check.scale_is_off))


def test_no_scale_is_estimated_where_the_robot_does_not_turn():
    check = heading_check(run_of(np.random.default_rng(2), amplitude=0.0, bias_rad_s=0.02))
    assert not check.scale_is_off.any()
    assert check.bias_rad_s[check.bias_windows] == pytest.approx(0.02, abs=0.006)


def test_headings_that_are_not_chained_may_jump():
    """By a radian where the window changes."""
    smooth, jumped = (
        heading_check(run_of(np.random.default_rng(3), jump_rad=jump_rad))
        for jump_rad in (0.0, 1.0)
    )
    np.testing.assert_allclose(jumped.bias_rad_s, smooth.bias_rad_s, atol=1e-9)


def test_a_spike_of_the_gyroscope_determines_nothing():
    run = run_of(np.random.default_rng(4))
    spiky = run.odometry["gyro_z"].copy()
    spiky[200::97] = 50.0
    columns = {name: run.odometry[name] for name in ("t", "v_left", "v_right")}
    table = Table(Path("t.csv"), columns | {"gyro_z": spiky}, np.arange(SIZE) + 2)
    check = heading_check(replace(run, odometry=table))
    assert np.abs(check.bias_rad_s).max() < 0.006
    assert not check.scale_is_off.any()


def test_windows_end_every_half_second_and_those_that_tell_the_bias_do_not_overlap():
    check = heading_check(run_of(np.random.default_rng(0)))
    assert np.diff(check.stamps_s) == pytest.approx(EVERY_S)
    assert np.diff(check.stamps_s[check.bias_windows]).min() >= WINDOW_S - 1e-6


def test_each_window_knows_only_what_was_measured_before_its_end():
    """But for the noise of a heading, which is that of the run."""
    run = run_of(np.random.default_rng(6))
    half = replace(
        run, odometry=run.odometry.rows(slice(0, 1500)), pose=run.pose.rows(slice(0, 300))
    )
    whole, first = heading_check(run), heading_check(half)
    count = len(first.stamps_s)
    np.testing.assert_allclose(whole.bias_rad_s[:count], first.bias_rad_s, atol=2e-4)


@pytest.mark.parametrize("lacks", ["pose", "gyro", "yaw"])
def test_without_headings_or_gyroscope_there_is_no_check(lacks):
    run = run_of(np.random.default_rng(7))
    if lacks == "pose":
        run = replace(run, pose=None)
    elif lacks == "gyro":
        columns = {name: run.odometry[name] for name in ("t", "v_left", "v_right")}
        run = replace(run, odometry=Table(Path("t.csv"), columns, np.arange(SIZE) + 2))
    else:
        columns = {name: run.pose[name] for name in ("t", "x", "y")}
        columns["yaw"] = np.full(len(run.pose.stamps_s), np.nan)
        run = replace(run, pose=Table(Path("p.csv"), columns, np.arange(600) + 2))
    assert heading_check(run) is None


def weak_check(scale, sigma, *, found):
    """Two minutes of windows that determine the scale by so much each."""
    ends_s = WINDOW_S + EVERY_S * np.arange(240)
    nothing = np.zeros(len(ends_s))
    scales = scale + 0.3 * sigma * np.sin(ends_s)
    return HeadingCheck(ends_s, nothing, nothing, scales, nothing + sigma, found)


def test_headings_found_from_positions_show_a_scale_over_the_run():
    """Of two minutes of windows 24 do not overlap: 0.09 becomes 0.018, and 0.15 is off by it."""
    check = weak_check(1.15, 0.09, found=True)
    assert not check.scale_is_off[check.stamps_s < 30.0].any()
    assert check.scale_is_off[check.stamps_s > 100.0].all()
    assert not check.scale_is_right[check.stamps_s > 100.0].any()
    assert not weak_check(1.06, 0.09, found=True).scale_is_off.any()


def test_measured_headings_show_a_scale_in_some_seconds_alone():
    """All those of a real run are off together by up to a tenth."""
    assert not weak_check(1.15, 0.09, found=False).scale_is_off.any()
