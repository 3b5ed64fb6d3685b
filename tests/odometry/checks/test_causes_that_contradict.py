"""Causes that are contradicted: by another sensor, or by what is left when they are undone."""

from dataclasses import replace

import numpy as np
import pytest

from odometry.checks.evidence.evidence import Evidence
from odometry.checks.findings.finding import Level
from odometry.checks.recording import check_recording
from odometry.checks.unexplained.beyond_slip import beyond_slip
from tests.odometry.checks.answers import UNKNOWN, seen, warnings
from tests.odometry.checks.drives import drive, to_and_fro, turning_all_round, winding
from tests.odometry.checks.faulty import pose_stamps, positions, put, treads, without_gyroscope


def late(run, seconds, *names):
    t = run.pose["t"]
    columns = {n: np.unwrap(run.pose[n]) if n == "yaw" else run.pose[n] for n in names}
    return put(run, "pose", **{n: np.interp(t - seconds, t, c) for n, c in columns.items()})


@pytest.mark.parametrize("names", [("yaw",), ("x", "y")], ids=["yaw", "positions"])
def test_yaw_or_positions_alone_are_not_late_poses(names):
    run = late(to_and_fro(), 0.8, *names)
    assert warnings(run) == ["yaw_late" if names == ("yaw",) else "positions_late"]
    assert warnings(without_gyroscope(run)) == UNKNOWN
    assert "are not of one time" in seen(without_gyroscope(run))


def test_all_of_the_poses_late_are_late_poses():
    (found,) = check_recording(pose_stamps(to_and_fro(), lambda t: t + 0.8)).at(Level.WARNING)
    assert found.name == "pose_late"
    assert "yaw alone" not in found.cause


def test_late_yaw_of_a_steady_speed_may_be_yaw_alone():
    at_s = 0.05 * np.arange(2400)
    steady = drive(np.full(2400, 0.8), 0.5 * np.sin(at_s / 3) + 0.2 * np.sin(at_s / 1.3))
    (found,) = check_recording(pose_stamps(steady, lambda t: t + 0.6)).at(Level.WARNING)
    assert found.name == "pose_late"
    assert "or those of yaw alone: the positions do not decide" in found.cause


def test_one_tread_that_is_late_is_not_both():
    run = treads(to_and_fro(), lambda left, right: (left, np.roll(right, 10)))
    (found,) = check_recording(run).at(Level.WARNING)
    assert found.name == "tread_late"
    assert found.cause.startswith("v_right alone is late")
    both = treads(to_and_fro(), lambda left, right: (np.roll(left, 10), np.roll(right, 10)))
    assert warnings(both) == ["treads_late"]


@pytest.mark.parametrize("drives", [winding, to_and_fro])
def test_treads_that_slip_are_within_what_slip_allows(drives):
    run = drives()
    slips = 0.2 + 0.8 * (np.sin(run.odometry["t"] / 4) > 0)
    slipped = treads(run, lambda left, right: (left / slips, right / slips[::-1]))
    assert beyond_slip(Evidence(run)) == beyond_slip(Evidence(slipped)) == ""


@pytest.mark.parametrize(
    "read",
    [
        lambda speed: (speed + 0.7) % 1.4 - 0.7,
        lambda speed: np.where(np.abs(speed) < 0.65, 0.0, speed),
        lambda speed: np.maximum(speed, 0.0),
    ],
    ids=["wrapped", "dead band", "forwards alone"],
)
def test_motion_that_no_slip_explains_is_said(read):
    run = treads(to_and_fro(), lambda left, right: (read(left), read(right)))
    assert "beyond what any slip" in beyond_slip(Evidence(run))
    assert check_recording(run).at(Level.WARNING)


def test_backwards_that_reads_nothing_is_no_lost_sign():
    lost = treads(to_and_fro(), lambda *speeds: tuple(np.maximum(speed, 0.0) for speed in speeds))
    assert "treads_unsigned" not in warnings(lost)
    unsigned = treads(to_and_fro(), lambda *speeds: tuple(np.abs(speed) for speed in speeds))
    assert warnings(unsigned) == ["treads_unsigned"]


def test_poses_of_another_robot_for_a_while_are_no_jump():
    run, other = turning_all_round(), turning_all_round(seed=1)
    rows = (run.pose["t"] > 90) & (run.pose["t"] < 103)
    columns = {}
    for name in ("x", "y", "yaw"):
        columns[name] = run.pose[name].copy()
        columns[name][rows] = other.pose[name][::-1][rows] + 7.0 * (name == "x")
    assert warnings(put(run, "pose", **columns)) == UNKNOWN
    moved = positions(run, lambda x, y: (np.where(rows, x + 4.0, x), y))
    assert warnings(moved) == ["pose_jumps"]


def test_a_scale_of_one_direction_is_no_change_of_the_scale():
    """All of the first half forwards, most of the second one backwards."""
    at_s = 0.05 * np.arange(4000)
    speed = np.where(at_s < 100, 1.0, -0.8) + 0.2 * np.sin(at_s / 5)
    run = drive(speed, 0.5 * np.sin(at_s / 3) + 0.2 * np.sin(at_s / 1.3))
    scaled = treads(run, lambda *of: tuple(np.where(v < 0, v / 1.6, v) for v in of))
    assert "tread_scale_changed" not in warnings(scaled)


def test_ticks_are_no_certain_wheel_rate():
    run = replace(to_and_fro(), robot=replace(to_and_fro().robot, wheel_radius=None))
    ticks = treads(run, lambda *speeds: tuple(np.round(73.0 * speed) for speed in speeds))
    (found,) = check_recording(ticks).at(Level.WARNING)
    assert found.name == "tread_unit"
    assert "encoder ticks" in found.cause


def test_speeds_that_read_zero_below_a_limit_are_no_lost_samples():
    noise = 0.05 * np.random.default_rng(1).standard_normal(4000)
    run = treads(
        to_and_fro(), lambda *of: tuple(np.where(np.abs(v + noise) < 0.5, 0.0, v) for v in of)
    )
    assert "dropped_speeds" not in [finding.name for finding in check_recording(run).findings]


@pytest.mark.parametrize(("lasts_s", "filtered"), [(15.0, False), (2.0, True)])
def test_positions_held_beside_a_fresh_yaw_are_no_lost_reference(lasts_s, filtered):
    run = turning_all_round()
    rows = (run.pose["t"] > 60) & (run.pose["t"] < 60 + lasts_s)
    first = int(np.flatnonzero(rows)[0])
    held = {n: np.where(rows, run.pose[n][first], run.pose[n]) for n in ("x", "y")}
    (found,) = check_recording(put(run, "pose", **held)).at(Level.WARNING)
    assert found.name == "frozen_poses"
    assert "while yaw goes on" in found.cause
    assert ("a median" in found.cause) == filtered


def test_curved_speeds_are_said_where_slip_hides_what_they_are():
    rng = np.random.default_rng(0)
    slip = 1 + 0.25 * np.repeat(rng.standard_normal((2, 200)), 20, axis=1)
    bent = treads(
        to_and_fro(), lambda *of: tuple(v * np.abs(v) * s for v, s in zip(of, slip, strict=True))
    )
    assert warnings(bent) == UNKNOWN
    assert "m at a quarter of the ordinary fastest speed" in seen(bent)
