"""Faults that were once named as others, or not at all."""

from graphlib import TopologicalSorter

import numpy as np
import pytest

from odometry.checks.findings.consequences import CONSEQUENCES
from odometry.checks.findings.finding import Level
from odometry.checks.recording import check_recording
from odometry.recording.run import Run
from tests.odometry.checks.answers import warnings
from tests.odometry.checks.drives import drive, turning_all_round, winding
from tests.odometry.checks.faulty import gyroscope, pose_stamps, positions, treads, yaw


def test_no_finding_is_its_own_consequence():
    """Two that explain each other would both be left out, and the recording be called clean."""
    causes_first = list(TopologicalSorter(CONSEQUENCES).static_order())  # CycleError of a circle
    assert set(CONSEQUENCES) <= set(causes_first)


def test_yaw_that_lost_its_sign_is_no_heading():
    run = yaw(turning_all_round(), lambda angle: np.abs(np.angle(np.exp(1j * angle))))
    assert warnings(run) == ["yaw_unrelated"]


def standing_mostly(seed):
    at_s = 0.05 * np.arange(3000)
    moves = (at_s % 75 > 60) & (at_s % 75 < 63)
    return drive(0.8 * moves, 0.2 * moves, seed=seed)


@pytest.mark.parametrize("seed", range(4))
def test_a_robot_that_stands_most_of_the_time_is_clean(seed):
    assert warnings(standing_mostly(seed)) == []


@pytest.mark.parametrize("value", [-999.0, -1.0, 0.9])
def test_a_placeholder_in_one_of_fifty_rows_is_named(value):
    def corrupt(speeds):
        return np.where(np.arange(len(speeds)) % 50 == 7, value, speeds)

    run = treads(winding(), lambda left, right: (corrupt(left), corrupt(right)))
    (found,) = check_recording(run).at(Level.WARNING)
    assert found.name == "placeholder_speeds"
    assert f"v_left is {value:g} m/s in " in found.seen


def test_a_yaw_rate_in_counts_does_not_accuse_the_track_width():
    counts = gyroscope(winding(), lambda rate: np.round(131 * np.degrees(rate)))
    (found,) = check_recording(counts).at(Level.WARNING)
    assert found.name == "gyroscope_unit"
    assert float(found.seen.split(" is ")[1].split(" times")[0]) == pytest.approx(7505.7, rel=0.02)


@pytest.mark.parametrize(("turn", "is_degrees"), [(360.0, True), (400.0, False)])
def test_gradians_are_not_called_degrees(turn, is_degrees):
    (found,) = check_recording(gyroscope(winding(), lambda rate: rate * turn / (2 * np.pi))).at(
        Level.WARNING
    )
    assert found.name == "gyroscope_unit"
    assert ("degrees per second" in found.cause) == is_degrees


def test_speeds_clipped_forwards_alone_are_no_stuck_encoders():
    run = treads(winding(), lambda *speeds: tuple(np.minimum(speed, 1.2) for speed in speeds))
    assert set(warnings(run)) == {"saturated_speed"}


def test_a_robot_at_its_top_speed_is_not_clipped():
    """It goes as far for each metre of its treads there as elsewhere."""
    at_s = 0.05 * np.arange(2400)
    forward = np.minimum(1 + 0.3 * np.sin(at_s / 4), 1.2)
    top = forward == 1.2  # to the last digit in both treads: clean encoders, or commands
    driven = treads(
        drive(forward, np.sin(at_s / 3) * (1.2 - forward)),
        lambda *speeds: tuple(np.where(top, 1.3, np.minimum(speed, 1.29)) for speed in speeds),
    )
    found = {one.name: one for one in check_recording(driven).findings}
    assert found["saturated_speed"].level is Level.NOTE
    assert "top speed" in found["saturated_speed"].cause


def test_a_clock_of_the_poses_that_was_set_amid_the_drive_is_no_jump_of_positions():
    run = pose_stamps(winding(), lambda t: t + np.where(t > 60, 3600.0, 0.0))
    assert warnings(run) == ["clock_set"]


def test_speeds_that_round_to_zero_are_not_lost():
    run = winding()
    wobble = 0.3 * np.sin(np.arange(len(run.odometry)) * 1.7)
    slow = treads(run, lambda left, right: (0.15 * left + wobble, 0.15 * right + wobble))
    coarse = treads(slow, lambda *speeds: tuple(np.round(speed / 0.2) * 0.2 for speed in speeds))
    assert "coarse_speeds" in warnings(coarse)
    assert "dropped_speeds" not in [finding.name for finding in check_recording(coarse).findings]


def test_a_gyroscope_that_is_read_once_a_second_is_not_late():
    def read_slowly(rate):
        return rate[np.arange(len(rate)) // 20 * 20]

    assert warnings(gyroscope(turning_all_round(), read_slowly)) == ["gyroscope_held"]


def test_half_the_yaw_is_no_heading_that_was_corrected(shared_data):
    """Its jumps by half a turn, where the yaw wraps, hide no scale of a half."""
    recording = Run.read(shared_data / "motion" / "warthog_grass_20240729_1446")
    run = yaw(recording, lambda angle: np.angle(np.exp(1j * angle)) / 2)
    (found,) = check_recording(run).at(Level.WARNING)
    assert found.name == "sensors_disagree"
    assert "turns by 0.5" in found.seen


def test_a_robot_on_a_ferry_has_no_wrong_wheel_radius():
    run = turning_all_round()
    t = run.pose.stamps_s
    carried = positions(run, lambda x, y: (x + 0.9 * t, y + 0.3 * t))
    (found,) = check_recording(carried).at(Level.WARNING)
    assert found.name == "sensors_disagree"
    speed = float(found.seen.split("move on by ")[1].split(" m/s")[0])
    assert speed == pytest.approx(np.hypot(0.9, 0.3), rel=0.05)


ROWS = "t,v_left,v_right\n" + "".join(f"{0.1 * row:.1f},0.5,0.6\n" for row in range(20))
FILES = {
    "": "The file is empty",
    "# Monday\n" + ROWS: "a comment",
    ROWS.replace(",", "\t"): "semicolons or tabs",
    ROWS.replace(".", ","): "decimal commas",
    ROWS + "2.0,0.5\n": "The last row was cut",
}


@pytest.mark.parametrize("text", FILES)
def test_why_a_file_cannot_be_read(tmp_path, text):
    (tmp_path / "run.toml").write_text("[robot]\ntrack_width = 0.6\n")
    (tmp_path / "odometry.csv").write_text(text)
    (found,) = check_recording(tmp_path).findings
    assert FILES[text] in found.cause


@pytest.mark.parametrize("pause", [0.0, 0.3])
def test_a_yaw_that_turns_round_where_the_robot_reverses_is_its_course(pause):
    """Without a pause, and standing where it would be slow, for up to three seconds."""
    at_s = 0.05 * np.arange(2400)
    speed = 0.25 + 0.6 * np.sin(0.15 * at_s)
    speed = np.where(np.abs(speed) < pause / 2, 0.0, speed)
    run = drive(speed, 0.25 * np.sin(0.3 * at_s))
    assert warnings(run) == []
    turned = np.interp(run.pose.stamps_s, at_s, speed) < 0
    first = check_recording(yaw(run, lambda angle: angle + np.pi * turned)).findings[0]
    assert first.name == "yaw_jumps"
    assert first.cause.startswith("Yaw is the course over ground")
    lost = np.cumsum(np.isin(np.arange(len(turned)), [150, 320]))
    (found,) = check_recording(yaw(run, lambda angle: angle + np.pi * lost)).at(Level.WARNING)
    assert found.cause.startswith("Yaw jumps")
