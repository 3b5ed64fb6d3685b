"""A tread that stands, or keeps one value, while the robot drives on."""

from dataclasses import replace

import numpy as np
import pytest

from odometry.checks.evidence.evidence import Evidence
from odometry.checks.findings.undo import TREADS
from odometry.checks.recording import check_recording
from odometry.checks.treads.stuck_encoders import stuck_encoders
from odometry.checks.turns.measured_turns import measured_turns
from odometry.recording.run import Run
from odometry.recording.run_span import Span, cut_run
from tests.odometry.checks.drives import drive, winding
from tests.odometry.checks.faulty import SENSORS, held, limited, put


def stuck(run):
    return list(stuck_encoders(Evidence(run)))


def test_what_turns_are_measured_is_asked_once_for_all_times_in_which_a_tread_stands():
    evidence = Evidence(winding())
    pairs = zip(measured_turns(evidence), measured_turns(evidence), strict=True)
    assert all(first is again for first, again in pairs)


def straight_between_stands():
    """Half of the time at rest; turns at first, then straight on alone."""
    at_s = 0.05 * np.arange(4000)
    moves = (at_s % 40 > 20).astype(float)
    return drive(1.2 * moves, 0.4 * np.sin(at_s) * moves * (at_s < 80))


@pytest.mark.parametrize(
    ("sensors", "name", "begin_s", "end_s"),
    list(
        zip(SENSORS, ("v_left", "v_right", "v_left"), (100, 86, 103), (160, 196, 113), strict=True)
    ),
)
def test_a_tread_that_reads_zero_on_a_straight_drive_is_lost(name, begin_s, end_s, sensors):
    run = held(straight_between_stands(), name, begin_s, end_s, 0.0)
    found = check_recording(SENSORS[sensors](run)).findings[0]
    assert found.name == "stuck_encoder"
    assert found.seen.startswith(f"{name} stays at 0 m/s from ")
    begins_s, ends_s = np.ravel(found.spans_s)
    at_s = run.odometry.stamps_s
    moving = at_s[(at_s >= begin_s) & (at_s < end_s) & (run.odometry[f"v_{other(name)}"] > 0.5)]
    assert begins_s == pytest.approx(moving[0], abs=1.0)
    assert ends_s == pytest.approx(moving[-1], abs=1.0)


def other(name):
    return {"v_left": "right", "v_right": "left"}[name]


@pytest.mark.parametrize("sensors", SENSORS)
@pytest.mark.parametrize("value", [None, 0.0, 0.7])
def test_a_tread_that_keeps_a_value_for_ten_seconds_is_lost(value, sensors):
    (found,) = stuck(SENSORS[sensors](held(winding(), "v_right", 50, 60, value)))
    assert found.seen.startswith("v_right")


@pytest.mark.parametrize("sensors", SENSORS)
@pytest.mark.parametrize("name", ["v_left", "v_right"])
def test_a_tread_that_stands_all_the_time_is_lost(name, sensors):
    run = SENSORS[sensors](held(winding(), name, 0, 1e9, 0.0))
    found = check_recording(run).findings
    assert [finding.name for finding in found] == ["stuck_encoder"]
    assert "all the time" in found[0].seen


def test_noise_of_a_tread_that_reads_zero_hides_nothing():
    run = held(winding(), "v_left", 40, 70, 0.0)
    noise = 0.002 * np.random.default_rng(0).standard_normal(len(run.odometry))
    assert stuck(put(run, "odometry", v_left=run.odometry["v_left"] + noise))


def about_one_tread():
    """Turns about the left tread alone, of changing speed."""
    speed = 0.6 + 0.2 * np.sin(0.05 * np.arange(2400) / 5)
    return drive(speed, speed / (0.9 / 2))


@pytest.mark.parametrize("sensors", SENSORS)
def test_turns_about_one_tread_are_no_fault(sensors):
    assert stuck(SENSORS[sensors](held(about_one_tread(), "v_left", 0, 1e9, 0.0))) == []


@pytest.mark.parametrize("sensors", SENSORS)
def test_times_at_rest_are_no_fault(sensors):
    assert stuck(SENSORS[sensors](straight_between_stands())) == []


def test_commands_that_are_held_are_no_stuck_encoder():
    """Both columns keep their values together, whatever the robot does."""
    at_s = 0.05 * np.arange(2400)
    step = at_s // 6
    run = drive(1 + 0.3 * np.sin(step), 0.5 * np.sin(3 * step))
    left, right = (
        np.array([run.odometry[name][step == one].mean() for one in step])
        for name in ("v_left", "v_right")
    )
    assert stuck(put(run, "odometry", v_left=left, v_right=right)) == []


def test_a_span_that_is_cut_out_says_the_time_of_the_whole():
    run = cut_run(held(straight_between_stands(), "v_left", 100, 118, 0.0), Span(30.0, 190.0))
    (found,) = check_recording(run).findings
    assert np.ravel(found.spans_s) == pytest.approx([101, 118], abs=1.5)


def test_speeds_that_come_early_are_no_stuck_encoder(shared_data):
    run = Run.read(shared_data / "motion" / "husky_borealtc_flooring_00")
    at_s = run.odometry.stamps_s
    early = {name: np.interp(at_s + 0.6, at_s, run.odometry[name]) for name in TREADS}
    assert stuck(put(run, "odometry", **early)) == []


@pytest.mark.parametrize(("side", "poses"), [("v_left", True), ("v_right", False)])
def test_eighty_seconds_of_a_real_drive(shared_data, side, poses):
    run = Run.read(shared_data / "motion" / "warthog_grass_20240808_1556")
    run = held(run if poses else replace(run, pose=None), side, 60, 140, 0.0)
    found = check_recording(run).findings
    assert [finding.name for finding in found if finding.level == "warning"] == ["stuck_encoder"]
    assert found[0].spans_s[0][0] == pytest.approx(60.5, abs=1.0)


@pytest.mark.parametrize("sensors", SENSORS)
def test_commands_that_both_treads_hold_in_turn_are_no_stuck_encoder(sensors):
    """A joystick holds its values while the robot still follows the last ones."""
    run = winding()
    for begin_s in (20, 50, 80, 110):
        run = held(held(run, "v_left", begin_s, begin_s + 8), "v_right", begin_s + 10, begin_s + 18)
    assert stuck(SENSORS[sensors](run)) == []


def slow_and_fast():
    at_s = 0.05 * np.arange(4000)
    return drive(0.5 + 0.5 * np.sin(at_s / 11), 0.4 * np.sin(at_s / 3))


def test_a_limit_of_the_speeds_is_named_beside_the_encoder():
    (found,) = stuck(limited(slow_and_fast(), "v_right", lambda v: np.minimum(v, 0.7)))
    assert found.cause.startswith(
        "Either the encoder of the right tread is stuck or was lost; or it"
    )
    assert "or it is clipped at 0.7 m/s, its largest value" in found.cause
    (found,) = stuck(held(winding(), "v_right", 50, 60))
    assert found.cause == "The encoder of the right tread is stuck or was lost"


def test_a_dead_band_is_named_beside_the_encoder():
    run = slow_and_fast()
    for name in TREADS:
        run = limited(run, name, lambda v: np.where(np.abs(v) < 0.4, 0.0, v))
    found = stuck(run)
    assert found
    assert all("dead band" in one.cause for one in found)


def test_a_gyroscope_that_the_poses_contradict_loses_no_encoder():
    run = straight_between_stands()
    at_s = run.odometry["t"]
    pivots = (at_s > 62) & (at_s < 66)
    left, right = np.where(pivots, 0.0, run.odometry["v_left"]), run.odometry["v_right"]
    assert stuck(put(run, "odometry", v_left=left))
    turn = np.where(pivots, (right - left) * 0.93 / 0.9, run.odometry["gyro_z"])
    yaw = np.cumsum(turn) * 0.05
    agree = put(put(run, "odometry", v_left=left), "pose", yaw=yaw[::2])
    assert not stuck(agree)
