import math
from dataclasses import replace

import numpy as np
import pytest

from odometry.errors import RunFolderError
from odometry.feel.recorded.imu_check import ImuSums
from odometry.feel.recorded.signals import feel_signals, usual_rate_hz
from odometry.feel.recorded.windows import feel_windows
from odometry.geometry.se3 import rotation_from_roll_pitch_yaw
from tests.odometry.feel.feel_drives import drive, with_imu

RUN = drive("gravel", 1, seconds=12.0)


def scaled(names, factor):
    def change(columns):
        return columns | {name: columns[name] * factor for name in columns if name[:4] in names}

    return change


@pytest.mark.parametrize(
    ("change", "match"),
    [
        (scaled(("acce",), 1 / 9.81), r"size of 1\b.*g or mg"),
        (scaled(("acce",), 1000 / 9.81), "g or mg"),
        (scaled(("gyro",), 180 / math.pi), "degrees a second"),
        (lambda c: c | {"accel_x": c["accel_z"], "accel_z": c["accel_x"]}, r"\[sensors\] imu"),
        (lambda c: c | {"accel_z": -c["accel_z"]}, r"\[sensors\] imu"),
        (lambda c: {"t": c["t"], "gyro_x": np.full(len(c["t"]), np.nan)}, "numbers that change"),
        (lambda c: {"t": c["t"], "gyro_x": np.full(len(c["t"]), 0.1)}, "numbers that change"),
        (lambda c: {name: of[::50] for name, of in c.items()}, "rows a second"),
        (lambda c: c | {"t": c["t"] + 1e6}, "time in common"),
    ],
)
def test_what_cannot_be_felt_is_refused(change, match):
    with pytest.raises(RunFolderError, match=match):
        feel_signals(with_imu(RUN, change))


def test_an_axis_without_numbers_is_absent_and_the_others_stay():
    run = with_imu(RUN, lambda c: c | {"gyro_x": np.full(len(c["t"]), np.nan)})
    assert set(feel_signals(run).axes) == set(feel_signals(RUN).axes) - {"gyro_x"}


def test_axes_are_turned_into_the_robot_frame():
    attitude = [0.3, -0.2, 1.5]
    rotation = rotation_from_roll_pitch_yaw(np.array(attitude))

    def mounted(columns):
        for kind in ("gyro", "accel"):
            names = [f"{kind}_{axis}" for axis in "xyz"]
            turned = np.stack([columns[name] for name in names], axis=-1) @ rotation
            columns |= dict(zip(names, turned.T, strict=True))
        return columns

    turned = with_imu(RUN, mounted)
    turned = replace(turned, settings={**RUN.settings, "sensors": {"imu": attitude}})
    for name, column in feel_signals(RUN).axes.items():
        np.testing.assert_allclose(feel_signals(turned).axes[name], column, atol=1e-9)


def test_a_gap_of_the_imu_is_not_measured_and_a_bus_with_bursts_keeps_its_rate():
    def with_gap(columns):
        keep = (columns["t"] < 5.0) | (columns["t"] > 7.0)
        return {name: of[keep] for name, of in columns.items()}

    windows = feel_windows(with_imu(RUN, with_gap))
    begins, ends = windows.begins_s, windows.ends_s
    np.testing.assert_array_equal(windows.whole, (ends <= 5.0) | (begins > 7.0))
    bursts = np.repeat(np.arange(0, 10, 0.05), 5) + np.tile(np.arange(5) * 1e-4, 200)
    assert usual_rate_hz(bursts) == pytest.approx(100.0, rel=0.01)


def test_currents_that_drop_out_are_no_numbers():
    run = drive("gravel", 2, seconds=12.0)
    run.odometry.columns["current_left"][::3] = 0.0
    currents = feel_signals(run).currents_a
    assert np.isnan(currents[:, 0]).mean() == pytest.approx(1 / 3, abs=0.02)
    assert np.isfinite(feel_windows(run).motion["currents"]).all()


def test_the_axes_of_odometry_serve_where_there_is_no_imu():
    run = drive("gravel", 3, seconds=12.0, imu=False)
    with pytest.raises(RunFolderError, match="needs one"):
        feel_signals(run)
    rng = np.random.default_rng(0)
    run.odometry.columns["gyro_z"] = rng.normal(0.0, 0.1, len(run.odometry))
    windows = feel_windows(run)
    assert windows.axes == ("gyro_z",)
    assert windows.top_hz == pytest.approx(5.0)


def test_standing_is_no_feeling_and_a_short_run_is_refused():
    still = drive("gravel", 4, seconds=12.0, speed=0.0, turning=0.0)
    windows = feel_windows(still)
    assert windows.standing.all()
    assert not windows.felt.any()
    with pytest.raises(RunFolderError, match="expected a window of 2 s"):
        feel_windows(drive("gravel", 5, seconds=1.0))


def test_a_robot_that_turns_does_not_stand_whatever_its_treads_say():
    still = drive("gravel", 4, seconds=12.0, speed=0.0, turning=0.0)

    def turned(columns):
        late = columns["t"] >= 6.0
        return columns | {"gyro_z": columns["gyro_z"] + 0.2 * late}

    windows = feel_windows(with_imu(still, turned))
    before, after = windows.ends_s <= 6.0, windows.begins_s >= 6.0
    assert windows.standing[before].all()
    assert not windows.standing[after].any()
    assert not windows.whole[after].any()
    biased = with_imu(still, lambda columns: columns | {"gyro_z": columns["gyro_z"] + 0.03})
    assert feel_windows(biased).standing.all()


def delayed(seconds):
    return lambda columns: columns | {"t": columns["t"] + seconds}


@pytest.mark.parametrize(("seconds", "word"), [(5.0, "5.0 s later"), (-3.0, "3.0 s earlier")])
def test_stamps_of_another_clock_are_refused(seconds, word):
    run = drive("gravel", 6, seconds=60.0, turning=0.3)
    feel_signals(with_imu(run, delayed(0.3)))  # what a filter or a log delays
    with pytest.raises(RunFolderError, match=word):
        feel_signals(with_imu(run, delayed(seconds)))


def against(columns):
    return columns | {"gyro_z": -columns["gyro_z"]}


def test_a_gyroscope_that_turns_against_the_treads_is_refused():
    run = drive("gravel", 6, seconds=60.0, turning=0.3)
    with pytest.raises(RunFolderError, match="turns against the treads"):
        feel_signals(with_imu(run, against))
    feel_signals(with_imu(drive("gravel", 7, seconds=60.0, turning=0.0), against))
    feel_signals(with_imu(drive("gravel", 6, seconds=8.0, turning=0.3), against))  # too short


def test_a_steady_circle_against_the_treads_is_refused_and_a_bias_is_not():
    """A steady turn has no correlation; a bias looks like a turn the other way."""
    treads = np.tile([0.5, 0.54], (2000, 1))  # 0.1 rad/s of a track width of 0.4 m
    for yaw_rate, refused in ((-0.05, True), (-0.015, False), (0.05, False)):
        axes = {"gyro_z": np.full(2000, yaw_rate)}
        assert ("against" in ImuSums().plus(axes, treads, 100.0, 0.4).fault()) is refused
        assert ImuSums().plus(axes, treads, 400.0, 0.4).fault() == ""  # 5 s


def test_samples_that_repeat_are_counted_while_the_robot_moves():
    run = drive("gravel", 8, seconds=12.0)
    assert set(feel_signals(run).repeats.values()) == {0.0}
    rows = np.arange(len(run.imu)) // 2 * 2
    twice = with_imu(run, lambda c: c | {"accel_y": c["accel_y"][rows]})
    repeats = feel_signals(twice).repeats
    assert repeats.pop("accel_y") == pytest.approx(0.5, abs=0.01)
    assert set(repeats.values()) == {0.0}
    still = drive("gravel", 8, seconds=12.0, speed=0.0, turning=0.0)
    still = feel_signals(with_imu(still, lambda c: c | {"gyro_y": c["gyro_y"][rows]}))
    assert set(still.repeats.values()) == {0.0}


def test_a_drive_that_does_not_turn_says_nothing_of_the_clock():
    """Its samples stay where their stamps say."""
    straight = drive("gravel", 7, seconds=60.0, turning=0.0)
    late = feel_signals(with_imu(straight, delayed(5.0)))
    assert late.begin_s == pytest.approx(feel_signals(straight).begin_s + 5.0, abs=0.1)
