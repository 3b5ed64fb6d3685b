"""Treads that say that the robot turns while a gyroscope says that it does not."""

from dataclasses import replace

import numpy as np
import pytest

from odometry.checks.findings.finding import Level
from odometry.checks.recording import check_recording
from tests.odometry.checks.drives import winding
from tests.odometry.checks.faulty import put, without_gyroscope

BEGIN, END = 800, 1200  # 40 s to 60 s
SPEEDS = {"v_left": -0.3, "v_right": 0.3}


def standing(run, *, noise_m_s, gyroscope=True):
    """The robot stands for 20 s, and its treads turn as on the spot."""
    rng = np.random.default_rng(4)
    columns = {name: run.odometry[name].copy() for name in (*SPEEDS, "gyro_z")}
    for name, speed in SPEEDS.items():
        columns[name][BEGIN:END] = speed + rng.normal(0, noise_m_s, END - BEGIN)
    if gyroscope:
        columns["gyro_z"][BEGIN:END] = rng.normal(0, 0.003, END - BEGIN)
    return put(replace(run, pose=None), "odometry", **columns)


def held_speeds(run):
    """The run with speeds that stay for half a second each, as commands do."""
    rows = np.arange(len(run.odometry)) // 10 * 10
    return put(run, "odometry", **{name: run.odometry[name][rows] for name in SPEEDS})


def findings(run):
    """But for the notes that a winding drive has without poses, and speeds that are held."""
    notes = ("straight_drives", "treads_held")
    return [one for one in check_recording(run).findings if one.name not in notes]


def only(run):
    (found,) = findings(run)
    ((begin_s, end_s),) = found.spans_s
    assert (begin_s, end_s) == (pytest.approx(40.0, abs=1.0), pytest.approx(60.0, abs=1.0))
    return found


def test_speeds_that_else_differ_from_row_to_row_are_frozen():
    found = only(standing(winding(), noise_m_s=0.0))
    assert (found.name, found.level) == ("treads_frozen", Level.WARNING)
    assert "(-0.3, 0.3) m/s from 40.0 to 60.0 s of run time" in found.seen
    assert found.cause.startswith("Odometry is lost")
    assert "blocked" not in found.cause


def test_speeds_that_stay_equal_elsewhere_too_may_be_those_of_a_blocked_robot():
    found = only(standing(held_speeds(winding()), noise_m_s=0.0))
    assert found.name == "treads_frozen"
    assert found.cause.startswith("Either odometry is lost")
    assert "blocked or its wheels spin" in found.cause


def test_currents_that_go_on_changing_show_a_blocked_robot():
    run = standing(held_speeds(winding()), noise_m_s=0.0)
    current = 8 + np.random.default_rng(2).standard_normal(len(run.odometry))
    found = only(put(run, "odometry", current_left=current, current_right=current))
    assert found.name == "treads_frozen"
    assert found.cause.startswith("The robot is blocked or its wheels spin")


def test_speeds_that_change_are_those_of_a_blocked_robot():
    found = only(standing(winding(), noise_m_s=0.01))
    assert (found.name, found.level) == ("turn_blocked", Level.WARNING)
    assert found.cause.startswith("Either the robot is blocked or its wheels spin")


@pytest.mark.parametrize("noise_m_s", [0.0, 0.01])
def test_a_gyroscope_that_holds_one_value_contradicts_nothing(noise_m_s):
    run = standing(winding(), noise_m_s=noise_m_s, gyroscope=False)
    silent = run.odometry["gyro_z"].copy()
    silent[BEGIN:END] = 0.0
    found = findings(put(run, "odometry", gyro_z=silent))
    assert [finding.name for finding in found] == ["gyroscope_dead"]


@pytest.mark.parametrize("noise_m_s", [0.0, 0.01])
def test_poses_that_turn_as_the_treads_contradict_the_gyroscope(noise_m_s):
    """A steady turn by poses and treads, of which the gyroscope reads noise about zero."""
    run = winding()
    turned = replace(standing(run, noise_m_s=noise_m_s), pose=run.pose)
    rate = 0.93 * 0.6 / 0.9
    at_s = run.pose["t"]
    more = np.interp(at_s, [40.0, 60.0], [0.0, 20 * rate])
    raw = np.unwrap(run.pose["yaw"])
    still = np.where(at_s < 40.0, raw, raw[np.searchsorted(at_s, 40.0)])
    after = np.where(at_s > 60.0, raw - raw[np.searchsorted(at_s, 60.0)], 0.0)
    turned = put(turned, "pose", yaw=np.angle(np.exp(1j * (still + more + after))))
    names = {finding.name for finding in check_recording(turned).findings}
    assert not names & {"turn_blocked"}


@pytest.mark.parametrize("of", [winding, lambda: held_speeds(winding())])
def test_a_drive_whose_turns_are_measured_has_none(of):
    for run in (of(), replace(of(), pose=None), without_gyroscope(of())):
        names = {finding.name for finding in check_recording(run).findings}
        assert not names & {"treads_frozen", "turn_blocked"}


def test_a_robot_that_stands_for_less_than_three_seconds_is_none():
    run = standing(winding(), noise_m_s=0.0)
    whole = winding()
    late = np.arange(len(run.odometry)) >= BEGIN + 50
    columns = {
        name: np.where(late, whole.odometry[name], run.odometry[name])
        for name in (*SPEEDS, "gyro_z")
    }
    names = {f.name for f in check_recording(put(run, "odometry", **columns)).findings}
    assert not names & {"treads_frozen", "turn_blocked"}


def test_a_tread_that_is_scaled_wrongly_on_straights_does_not_turn_the_robot():
    run = winding()
    ahead = {"v_left": 1.0, "v_right": 1.4}
    columns = {name: run.odometry[name].copy() for name in (*ahead, "gyro_z")}
    noise = np.random.default_rng(6).standard_normal((3, END - BEGIN))
    for name, speed, of in zip(columns, (*ahead.values(), 0.0), noise, strict=True):
        columns[name][BEGIN:END] = speed + 0.003 * of
    names = {
        f.name
        for f in check_recording(put(replace(run, pose=None), "odometry", **columns)).findings
    }
    assert "turn_blocked" not in names


def test_held_speeds_on_a_terrain_that_turns_half_as_much_are_not_frozen():
    run = standing(winding(), noise_m_s=0.0)
    rate = 0.5 * 0.93 * 0.6 / 0.9
    turns = run.odometry["gyro_z"].copy()
    turns[BEGIN:END] += rate
    names = {one.name for one in findings(put(run, "odometry", gyro_z=turns))}
    assert not names & {"treads_frozen", "turn_blocked"}
