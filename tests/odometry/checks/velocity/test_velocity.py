"""Velocities in another unit, frame or sign are named, and right ones are not."""

from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

from odometry.checks.evidence.evidence import Evidence
from odometry.checks.recording import check_recording
from odometry.checks.velocity.velocity import VELOCITY_FAULTS
from odometry.checks.velocity.velocity_ways import velocity_ways
from odometry.tables.table import Table
from tests.odometry.checks.drives import PERIOD_S, drive, uneven
from tests.odometry.checks.faulty import put

AT_S = PERIOD_S * np.arange(3000)
SPEED_M_S = 0.8 + 0.3 * np.sin(AT_S / 5) + 0.1 * np.sin(AT_S / 1.7)
TURN_RAD_S = 0.4 * np.sin(AT_S / 3.3) + 0.3 * np.sin(AT_S / 1.9) + 0.05
ASIDE_M = -0.2  # the robot moves to its left by this much of its turn


def with_velocity(change, run=None, seed=0):
    """A drive and what a sensor at 5 Hz measures of it, changed."""
    run = run or drive(SPEED_M_S, TURN_RAD_S)
    rows = np.arange(4, len(AT_S), 4)
    noise = 0.02 * np.random.default_rng(seed).standard_normal((3, len(rows)))
    vx, vy, wz = np.stack([SPEED_M_S, ASIDE_M * TURN_RAD_S, TURN_RAD_S])[:, rows] + noise
    yaw = np.cumsum(TURN_RAD_S)[rows] * PERIOD_S
    stamps_s, vx, vy, wz = change(AT_S[rows], vx, vy, wz, yaw)
    columns = {"t": stamps_s, "vx": vx, "vy": vy, "wz": wz}
    return replace(run, velocity=Table(Path("velocity.csv"), columns, rows))


def found_in(run):
    return [one for one in check_recording(run).findings if one.name in VELOCITY_FAULTS]


def on_the_map(at_s, vx, vy, wz, yaw):
    return at_s, vx * np.cos(yaw) - vy * np.sin(yaw), vx * np.sin(yaw) + vy * np.cos(yaw), wz


FAULTS = {
    "km/h": (lambda t, x, y, w, _: (t, 3.6 * x, 3.6 * y, w), "velocity_unit", "km/h"),
    "mm/s": (lambda t, x, y, w, _: (t, 1e3 * x, 1e3 * y, w), "velocity_unit", "mm/s"),
    "degrees": (lambda t, x, y, w, _: (t, x, y, np.degrees(w)), "velocity_unit", "degrees per"),
    "no unit": (lambda t, x, y, w, _: (t, 7.3 * x, y, w), "velocity_unit", "turned or tilted"),
    "turns by no unit": (lambda t, x, y, w, _: (t, x, y, 2 * w), "velocity_unit", "Either wz"),
    "backwards": (lambda t, x, y, w, _: (t, -x, -y, w), "velocity_reversed", "backwards"),
    "clockwise": (lambda t, x, y, w, _: (t, x, y, -w), "velocity_reversed", "wz is clockwise"),
    "map": (on_the_map, "velocity_axes", "axes of"),
    "exchanged": (lambda t, x, y, w, _: (t, y, x, w), "velocity_axes", "exchanged"),
    "nothing": (lambda t, x, y, w, _: (t, 0 * x, y, w), "velocity_unrelated", "never measured"),
    "no turns": (lambda t, x, y, w, _: (t, x, y, 0 * w), "velocity_unrelated", "never measured"),
    "another drive": (
        lambda t, _, y, w, __: (t, 0.6 * np.sin(t / 2.7), y, w),
        "velocity_unrelated",
        "another recording",
    ),
}


def right(at_s, vx, vy, wz, _):
    return at_s, vx, vy, wz


@pytest.fixture(scope="module", params=["poses", "treads and gyroscope alone"])
def run(request):
    run = drive(SPEED_M_S, TURN_RAD_S)
    return run if request.param == "poses" else replace(run, pose=None)


@pytest.mark.parametrize("fault", FAULTS)
def test_a_fault_of_the_velocities_is_named(run, fault):
    change, name, words = FAULTS[fault]
    (found,) = found_in(with_velocity(change, run))
    assert found.name == name
    assert words in found.cause
    assert "velocity.csv" in found.remedy


def test_velocities_of_the_robot_are_no_fault(run):
    assert not found_in(with_velocity(right, run))


def test_treads_that_are_exchanged_do_not_accuse_a_turn_rate(run):
    """The gyroscope, and the poses, turn as it does."""
    treads = {"v_left": run.odometry["v_right"], "v_right": run.odometry["v_left"]}
    columns = {**run.odometry.columns, **treads}
    swapped = replace(run, odometry=replace(run.odometry, columns=columns))
    assert found_in(with_velocity(right, swapped)) == []
    names = [one.name for one in check_recording(with_velocity(right, swapped)).findings]
    assert {"treads_swapped", "treads_or_gyroscope_reversed"} & set(names)
    clockwise, *_ = FAULTS["clockwise"]
    assert [one.name for one in found_in(with_velocity(clockwise, run))] == ["velocity_reversed"]


def test_a_left_that_is_right_is_named_where_poses_say_what_left_is():
    run = drive(SPEED_M_S, TURN_RAD_S, sigma_m=0.005, yaw_sigma=0.003)
    yaw = np.cumsum(TURN_RAD_S)[::2] * PERIOD_S
    x, y = run.pose["x"] - 0.5 * np.cos(yaw), run.pose["y"] - 0.5 * np.sin(yaw)

    def to_the_right(at_s, vx, _, wz, __):
        return at_s, vx, 0.5 * wz, wz

    (found,) = found_in(with_velocity(to_the_right, put(run, "pose", x=x, y=y)))
    assert found.name == "velocity_reversed"
    assert "vy is to the right" in found.cause


def test_treads_that_slip_do_not_accuse_a_velocity():
    slips = replace(drive(SPEED_M_S, TURN_RAD_S), pose=None)
    treads = {name: 3 * slips.odometry[name] for name in ("v_left", "v_right")}
    assert not found_in(with_velocity(right, put(slips, "odometry", **treads)))


def test_turns_that_are_noise_of_the_poses_accuse_no_turn_rate():
    straight = drive(0.14 + 0 * AT_S, 0.03 * np.sin(AT_S / 3), yaw_sigma=0.02)

    def slow(at_s, vx, vy, wz, _):
        turn = 0.03 * np.sin(at_s / 3) + 0.01 * np.random.default_rng(1).standard_normal(len(at_s))
        return at_s, 0.14 + 0 * vx, 0 * vy, turn + 0 * wz

    assert not found_in(with_velocity(slow, straight))


def test_empty_cells_and_gaps_are_not_measured():
    run = with_velocity(right)
    vx, at_s = run.velocity["vx"].copy(), run.velocity["t"]
    vx[(at_s > 40) & (at_s < 60)] = np.nan
    run = put(run, "velocity", vx=vx, vy=np.full(len(vx), np.nan))
    motion, ways = Evidence(run).motion, velocity_ways(Evidence(run))
    inside = (motion.end_s > 40.5) & (motion.start_s < 59.5)
    assert np.isnan(ways.ahead[inside]).all()
    assert np.isfinite(ways.turned[inside]).all()
    assert np.isnan(ways.left).all()
    known = np.isfinite(ways.ahead)
    driven = np.array(
        [
            SPEED_M_S[(b <= AT_S) & (e > AT_S)].sum() * PERIOD_S
            for b, e in zip(motion.start_s, motion.end_s, strict=True)
        ]
    )
    assert ways.ahead[known] == pytest.approx(driven[known], abs=0.03)
    assert not found_in(run)


def test_a_run_without_velocities_says_nothing_of_them():
    assert velocity_ways(Evidence(uneven())) is None
    assert not found_in(uneven())
