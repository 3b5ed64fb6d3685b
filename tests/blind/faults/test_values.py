"""Faults by their figures, read again with another reader."""

import math
import tomllib

import numpy as np
import pytest

from tests.blind.faults.catalogue import FAULTS, make_case


def read(folder, name):
    return np.genfromtxt(folder / f"{name}.csv", delimiter=",", names=True)


@pytest.fixture
def case(bases, tmp_path):
    def draw(key, seed=0):
        folder = tmp_path / f"{key}_{seed}"
        base = make_case(FAULTS[key], bases[:2], seed, folder)
        name = "pose" if key.startswith("pose") else "odometry"
        return read(base.folder, name), read(folder, name)

    return draw


@pytest.mark.parametrize(
    ("key", "factor"),
    [
        ("treads_in_rad_s", 1 / 0.3),
        ("treads_in_rpm", 60 / (2 * math.pi * 0.3)),
        ("treads_in_mm_s", 1000),
        ("treads_in_cm_s", 100),
        ("treads_in_km_h", 3.6),
        ("treads_in_feet_s", 3.28084),
        ("treads_in_mph", 2.23694),
        ("treads_twice", 2),
        ("treads_half", 0.5),
        ("treads_both_negative", -1),
        ("treads_in_metres_a_row", 0.05),
    ],
)
def test_units_of_treads(case, key, factor):
    clean, faulty = case(key)
    for side in ("v_left", "v_right"):
        drives = np.abs(clean[side]) > 0.1
        ratio = np.median(faulty[side][drives] / clean[side][drives])
        assert ratio == pytest.approx(factor, rel=1e-4)


def test_sides_of_treads(case):
    clean, faulty = case("treads_swapped")
    assert np.array_equal(faulty["v_left"], clean["v_right"])
    clean, faulty = case("tread_left_negative")
    assert np.array_equal(faulty["v_left"], -clean["v_left"])
    assert np.array_equal(faulty["v_right"], clean["v_right"])


@pytest.mark.parametrize("seed", range(5))
def test_a_stuck_encoder_holds_one_value_for_a_while(case, seed):
    clean, faulty = case("tread_right_stuck", seed)
    rows = np.flatnonzero(clean["v_right"] != faulty["v_right"])
    held = faulty["v_right"][rows[0] : rows[-1] + 1]
    assert np.ptp(held) == 0
    assert held[0] in {0.0, clean["v_right"][rows[0] - 1]}
    assert np.array_equal(clean["v_left"], faulty["v_left"])


@pytest.mark.parametrize("seed", range(5))
def test_an_absurd_sample_is_one_row(case, seed):
    clean, faulty = case("tread_absurd_sample", seed)
    change = np.maximum(*(np.abs(clean[n] - faulty[n]) for n in ("v_left", "v_right")))
    assert np.count_nonzero(change) == 1
    assert change.max() > 4


def test_yaw_in_degrees(case):
    clean, faulty = case("pose_yaw_in_degrees")
    turns = (faulty["yaw"] - np.rad2deg(clean["yaw"])) / 360
    assert turns == pytest.approx(np.rint(turns), abs=1e-6)


@pytest.mark.parametrize("seed", range(4))
def test_late_poses(case, seed):
    clean, faulty = case("pose_late", seed)
    late = faulty["t"] - clean["t"]
    assert np.ptp(late) < 1e-8
    assert 0.1 <= late[0] <= 0.6


def test_a_drifting_clock_is_apart_at_the_end_only(case):
    clean, faulty = case("pose_clock_drifts")
    apart = np.abs(faulty["t"] - clean["t"])
    assert apart[0] == 0
    assert apart[-1] >= 0.79
    assert 0.005 <= apart[-1] / (clean["t"][-1] - clean["t"][0]) <= 0.02


@pytest.mark.parametrize("seed", range(4))
def test_a_jump_stays(case, seed):
    clean, faulty = case("pose_jumps_and_stays", seed)
    away = np.hypot(faulty["x"] - clean["x"], faulty["y"] - clean["y"])
    assert away[0] == 0
    assert 0.5 <= away[-1] <= 20
    assert len(np.unique(np.round(away, 6))) == 2


@pytest.mark.parametrize("key", ["pose_ned", "pose_mirrored", "pose_x_y_swapped"])
def test_mirrored_worlds_turn_the_other_way_round(case, key):
    """The signed area that the path encloses changes its sign; lengths do not change."""
    clean, faulty = case(key)
    area = [p["x"] @ np.roll(p["y"], -1) - p["y"] @ np.roll(p["x"], -1) for p in (clean, faulty)]
    assert area[1] == pytest.approx(-area[0])
    steps = [np.hypot(np.diff(p["x"]), np.diff(p["y"])) for p in (clean, faulty)]
    assert steps[1] == pytest.approx(steps[0])


def test_ned_headings_follow_the_motion(case):
    clean, faulty = case("pose_ned")
    along = [
        np.gradient(p["x"]) * np.cos(p["yaw"]) + np.gradient(p["y"]) * np.sin(p["yaw"])
        for p in (clean, faulty)
    ]
    assert along[1] == pytest.approx(along[0], abs=1e-6)
    assert np.diff(faulty["yaw"]) == pytest.approx(-np.diff(clean["yaw"]), abs=1e-6)


def test_latitude_and_longitude_are_of_the_same_path(case):
    clean, faulty = case("pose_in_latitude_longitude")
    spans = sorted(np.ptp(faulty[n]) * math.pi / 180 * 6_371_000 for n in "xy")
    assert max(np.abs(faulty["x"]).max(), np.abs(faulty["y"]).max()) < 180
    assert min(spans) < 1.01 * max(np.ptp(clean["y"]), np.ptp(clean["x"]))


def test_outliers_return(case):
    clean, faulty = case("pose_outliers")
    away = np.hypot(faulty["x"] - clean["x"], faulty["y"] - clean["y"])
    assert 0.005 < np.mean(away > 0) < 0.06
    assert away[away > 0].min() >= 0.99


def test_frozen_poses_hold_while_the_wheels_drive(case):
    clean, faulty = case("pose_frozen")
    held = np.flatnonzero(faulty["x"] != clean["x"])
    rows = slice(held[0], held[-1] + 1)
    assert all(np.ptp(faulty[name][rows]) == 0 for name in ("x", "y", "yaw"))
    assert np.ptp(clean["t"][rows]) > 0.09 * np.ptp(clean["t"])


def test_the_gyroscope(case):
    clean, faulty = case("gyro_in_degrees")
    assert faulty["gyro_z"] == pytest.approx(np.rad2deg(clean["gyro_z"]), abs=1e-8)
    clean, faulty = case("gyro_reversed")
    assert np.array_equal(faulty["gyro_z"], -clean["gyro_z"])
    clean, faulty = case("gyro_bias")
    bias = faulty["gyro_z"] - clean["gyro_z"]
    assert 0.02 <= abs(bias[0]) <= 0.08
    assert np.ptp(bias) < 1e-8


@pytest.mark.parametrize(("key", "factor"), [("ns", 1e9), ("us", 1e6), ("ms", 1e3)])
def test_units_of_stamps(case, key, factor):
    clean, faulty = case(f"stamps_in_{key}")
    assert np.diff(faulty["t"]) == pytest.approx(np.diff(clean["t"]) * factor, rel=1e-4, abs=1)


def test_rows_that_are_lost_leave_the_rest(case):
    clean, faulty = case("rows_lost")
    assert set(faulty["t"]) < set(clean["t"])
    gap = np.diff(faulty["t"]).max()
    assert 3.0 <= gap <= 20.2
    assert np.sum(np.diff(faulty["t"]) > 1) == 1


@pytest.mark.parametrize("seed", range(6))
def test_a_far_track_width_is_beyond_what_skidding_explains(bases, tmp_path, seed):
    """Both Warthogs turn as if 1.68 to 1.75 times as wide as their 1.08 m."""
    make_case(FAULTS["track_width_far"], bases[:2], seed, tmp_path / "run")
    width_m = tomllib.loads((tmp_path / "run" / "run.toml").read_text())["robot"]["track_width"]
    ratio = 1.08 * 1.7 / width_m
    assert 0.19 < ratio < 0.62 or 3.4 < ratio < 7.3
