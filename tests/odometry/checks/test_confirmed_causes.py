"""A cause that does not explain is not named, and one that does is, with its consequences."""

from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

from odometry.checks.evidence.evidence import Evidence
from odometry.checks.findings.finding import Finding, Level
from odometry.checks.findings.undo import (
    between,
    changed,
    exchanged,
    in_turn,
    moved,
    sooner,
    times,
    treads_times,
)
from odometry.checks.recording import check_recording
from odometry.tables.table import Table
from tests.odometry.checks.answers import warnings
from tests.odometry.checks.drives import drive, turning_all_round, winding
from tests.odometry.checks.faulty import FAULTS, pose_stamps, positions, put, treads, yaw


def test_poses_of_another_drive_are_not_late():
    other = drive(*np.roll([winding().odometry["v_left"] * 0.9, winding().odometry["gyro_z"]], 700))
    named = warnings(replace(turning_all_round(), pose=other.pose))
    assert named
    assert not {"pose_late", "far_sensor", "clocks_apart", "pose_mirrored"} & set(named)


@pytest.mark.parametrize("ahead_s", [0.5, 2.0, 3.0])
def test_poses_far_ahead_are_reported_as_early_alone(ahead_s):
    assert warnings(pose_stamps(turning_all_round(), lambda t: t - ahead_s)) == ["pose_late"]


def test_yaw_bent_by_iron_is_straightened():
    run = turning_all_round()
    bent = yaw(run, lambda angle: angle + 0.3 * np.sin(angle + 1))
    (found,) = check_recording(bent).at(Level.WARNING)
    assert found.name == "yaw_bent"
    off = np.angle(np.exp(1j * (found.mend(bent).pose["yaw"] - run.pose["yaw"])))
    assert np.ptp(off) < 0.05  # of 0.6


def test_positions_stretched_along_an_axis_are_shortened():
    run = turning_all_round()
    stretched = positions(run, lambda x, y: (x, 1.4 * y))
    (found,) = check_recording(stretched).at(Level.WARNING)
    assert found.name == "positions_stretched"
    assert "right angles" not in found.cause
    mended = found.mend(stretched).pose.stack("x", "y")
    sizes = np.ptp(mended, axis=0) / np.ptp(run.pose.stack("x", "y"), axis=0)
    assert sizes[1] / sizes[0] == pytest.approx(1.0, abs=0.06)


def test_positions_stretched_off_the_axes_may_have_axes_that_lean():
    leaning = positions(turning_all_round(), lambda x, y: (x + 0.35 * y, y))
    (found,) = check_recording(leaning).at(Level.WARNING)
    assert found.name == "positions_stretched"
    assert "its axes are not at right angles" in found.cause


def test_commands_are_distinguished_from_stamps_that_are_early():
    run = turning_all_round()
    columns = {}
    for name in ("v_left", "v_right"):
        speed = run.odometry[name]
        slow = np.convolve(np.pad(speed, 4, "edge"), np.ones(9) / 9, "valid")
        columns[name] = slow + 0.5 * np.gradient(slow, 0.05)  # a lag of 0.5 s makes it the speed
    assert warnings(put(run, "odometry", **columns)) == ["treads_are_commands"]
    shifted = {n: np.interp(run.odometry["t"] + 0.5, run.odometry["t"], run.odometry[n])
               for n in ("v_left", "v_right")}  # fmt: skip
    (found,) = check_recording(put(run, "odometry", **shifted)).at(Level.WARNING)
    assert "stamps" in found.cause.lower()


def test_a_duty_cycle_is_neither_a_scale_nor_one_side():
    run = turning_all_round()
    squared = treads(run, lambda left, right: (left * np.abs(left), right * np.abs(right)))
    assert warnings(squared) == ["treads_not_proportional"]


def test_the_mean_in_one_column_is_no_track_width():
    run = turning_all_round()
    assert warnings(treads(run, lambda left, right: (left, (left + right) / 2))) == [
        "sensors_disagree"
    ]


def test_positions_that_wander_aside_did_not_jump():
    run = turning_all_round()
    aside = 4 * np.exp(-0.5 * ((run.pose["t"] - 100) / 5) ** 2)
    (found,) = check_recording(positions(run, lambda x, y: (x + aside, y - aside))).at(
        Level.WARNING
    )
    assert found.name == "sensors_disagree"
    assert "from where treads and yaw lead" in found.seen


@pytest.mark.parametrize("fault", ["pose_mirrored", "gyroscope_reversed", "treads_swapped"])
def test_a_drive_that_repeats_itself_is_not_late_where_a_turn_is_reversed(fault):
    at_s = 0.05 * np.arange(4000)
    run = drive(np.full(4000, 0.8), 0.4 * np.sign(np.sin(at_s / 4)))
    assert warnings(FAULTS[fault](run)) == [fault]


def test_mends_undo_what_they_say():
    run = drive(np.full(100, 0.5), np.full(100, 0.2))
    left, right = run.odometry["v_left"], run.odometry["v_right"]
    assert (exchanged(run).odometry["v_left"] == right).all()
    scaled = treads_times(2.0, -1.0)(run).odometry
    assert (scaled["v_left"] == 2 * left).all()
    assert (scaled["v_right"] == -right).all()
    back = in_turn(times("pose", 2.0, "x"), changed("pose", "x", lambda x: x / 2))(run)
    assert (back.pose["x"] == run.pose["x"]).all()
    late = put(run, "odometry", v_left=run.odometry["t"])
    assert sooner(("v_left",), 0.1)(late).odometry["v_left"][10] == pytest.approx(
        run.odometry["t"][12]
    )
    heading = run.pose["yaw"] + 0.3
    far = positions(run, lambda x, y: (x + np.cos(heading), y + np.sin(heading)))
    assert moved(1.0, 0.0, 0.3)(far).pose["x"] == pytest.approx(run.pose["x"])
    part = between(run, 1.0, 2.0)
    assert (part.odometry["t"][0], part.pose["t"][-1]) == pytest.approx((1.0, 1.9))


def test_what_is_left_out_is_in_no_window():
    run = winding()
    evidence = Evidence(run, ((10.0, 20.0),))
    for motion in (evidence.motion, evidence.uniform):
        assert not ((motion.end_s >= 10.0) & (motion.start_s <= 20.0)).any()
    assert len(evidence.uniform) < len(Evidence(run).uniform)


def test_a_mend_is_no_part_of_the_report():
    found = Finding("scale", Level.WARNING, "a", "b", "c", mend=lambda run: run)
    assert found == Finding("scale", Level.WARNING, "a", "b", "c")
    assert "mend" not in found.to_table()


@pytest.mark.parametrize("attitude_rad", [(0.0,) * 3, ()])
def test_a_stated_attitude_is_doubted_before_the_gyroscope_is_negated(attitude_rad):
    run = winding()
    columns = {"t": run.odometry["t"], "gyro_z": -run.odometry["gyro_z"]}
    imu = Table(Path("imu.csv"), columns, np.arange(len(columns["t"])))
    sensors = {"imu": list(attitude_rad)} if attitude_rad else {}
    run = replace(run, imu=imu, settings={"sensors": sensors})
    (found,) = (f for f in check_recording(run).findings if f.name == "gyroscope_reversed")
    assert ("[sensors] imu" in found.cause) == bool(attitude_rad)
    assert ("[sensors] imu" in found.remedy) == bool(attitude_rad)
    assert "egate gyro_z of imu.csv" in found.remedy


@pytest.mark.parametrize(
    ("factor", "words"),
    [(2.0, "replay at half the speed; or yaw is half"), (0.5, "replay at twice the speed")],
)
def test_a_rate_that_is_off_by_two_may_be_of_a_replay(factor, words):
    run = turning_all_round()
    scaled = put(run, "odometry", gyro_z=factor * run.odometry["gyro_z"])
    (found,) = check_recording(scaled).at(Level.WARNING)
    assert found.name == "gyroscope_unit"
    assert words in found.cause
