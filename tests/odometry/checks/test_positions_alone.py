"""Poses without yaw, of receivers: what can be checked is, and nothing is made up."""

from dataclasses import replace

import numpy as np
import pytest

from odometry.checks.evidence.course_turns import course_turns
from odometry.checks.evidence.evidence import Evidence
from odometry.checks.findings.finding import Level
from odometry.checks.recording import check_recording
from odometry.checks.unexplained.position_differences import paths_apart
from tests.odometry.checks.drives import drive, starts_and_stops, turning_all_round
from tests.odometry.checks.faulty import FAULTS, gyroscope, put, without_gyroscope, without_yaw


def warnings(run):
    return [finding.name for finding in check_recording(run).at(Level.WARNING)]


@pytest.mark.parametrize("share", [1.0, 0.6, 0.3])
def test_a_clean_drive_has_no_warning(share):
    run = without_yaw(turning_all_round(), share)
    assert warnings(run) == []
    assert warnings(without_gyroscope(run)) == []


@pytest.mark.parametrize("sigma_m", [0.1, 0.5, 2.0])
def test_noisy_positions_have_no_warning(sigma_m):
    at_s = 0.05 * np.arange(4000)
    run = drive(np.full(4000, 0.7), 0.3 * np.sin(at_s / 4), sigma_m=sigma_m)
    assert warnings(without_yaw(run)) == []


def stop_and_go(sigma_m, seed):
    """Ten minutes of 10 s of driving and 10 s of rest, positions at 1 Hz."""
    at_s = 0.05 * np.arange(12_000)
    goes = np.sin(at_s * np.pi / 10) > 0
    run = drive(0.7 * goes, 0.3 * np.sin(at_s / 4) * goes)
    noise = np.random.default_rng(seed).normal(scale=sigma_m, size=(2, len(run.pose)))
    noisy = put(run, "pose", x=run.pose["x"] + noise[0], y=run.pose["y"] + noise[1])
    every = slice(None, None, round(1 / float(np.median(np.diff(run.pose.stamps_s)))))
    return without_yaw(replace(noisy, pose=noisy.pose.rows(every)))


@pytest.mark.parametrize("seed", range(3))
def test_noise_of_a_receiver_while_the_robot_stands_is_no_lost_odometry(seed):
    assert "treads_frozen" not in warnings(stop_and_go(0.5, seed))


def test_odometry_that_is_lost_is_warned_of_beside_noise():
    run = stop_and_go(0.02, 0)
    lost = (run.odometry["t"] > 200.0) & (run.odometry["t"] < 210.0)
    kept = {name: np.where(lost, 0.0, run.odometry[name]) for name in ("v_left", "v_right")}
    assert "treads_frozen" in warnings(put(run, "odometry", **kept))


def test_a_robot_that_turns_on_the_spot_has_no_course():
    at_s = 0.05 * np.arange(4000)
    run = without_yaw(drive(np.full(4000, 0.01), 0.6 * np.sign(np.sin(at_s / 3))))
    assert np.isnan(Evidence(run).pose_turn_rad).all()
    assert warnings(run) == []


@pytest.mark.parametrize(
    ("fault", "named"),
    [
        *((name, name) for name in ("position_unit", "tread_unit", "treads_swapped", "pose_jumps")),
        *((name, name) for name in ("tread_left_reversed", "gyroscope_unit", "gyroscope_reversed")),
        *((name, name) for name in ("frozen_poses", "pose_outliers", "pose_mirrored")),
        ("positions_mirrored", "pose_mirrored"),
        ("treads_both_reversed", "treads_swapped"),
    ],
)
def test_faults_are_named_by_positions_alone(fault, named):
    found = check_recording(without_yaw(FAULTS[fault](turning_all_round()))).at(Level.WARNING)
    assert [finding.name for finding in found] == [named]
    if fault == "treads_both_reversed":
        assert "both have the wrong sign" in found[0].cause


def test_positions_of_another_run_disagree():
    """A path that has nothing to do with treads and gyroscope: smooth, as fast, elsewhere."""
    run = without_yaw(winding(0.05 * np.arange(4000), 0))
    other = winding(0.05 * np.arange(4000), 10)
    mixed = put(run, "pose", x=other.pose["x"], y=other.pose["y"])
    assert warnings(run) == warnings(without_gyroscope(run)) == []
    (found,) = check_recording(mixed).at(Level.WARNING)
    assert found.name == "sensors_disagree"
    assert "similarity" in found.seen


@pytest.mark.parametrize(("degrees", "said"), [(5.0, True), (12.0, False)])
def test_on_steep_terrain_robots_slide_off_their_path(degrees, said):
    """Figure eights at 12 degrees have a similarity of 0.2, without any fault."""
    run = without_yaw(winding(0.05 * np.arange(4000), 0))
    other = winding(0.05 * np.arange(4000), 10)
    pitch = np.full(len(run.odometry), np.radians(degrees))
    mixed = put(run, "pose", x=other.pose["x"], y=other.pose["y"])
    assert bool(paths_apart(Evidence(put(mixed, "odometry", pitch=pitch)))) == said


def winding(at_s, seed):
    rng = np.random.default_rng(seed)
    rate = sum(
        0.3 * np.sin(at_s / length_s + phase)
        for length_s, phase in zip(rng.uniform(1, 8, 4), rng.uniform(0, 6, 4), strict=True)
    )
    return drive(np.full(len(at_s), 0.7), rate)


def test_without_gyroscope_either_may_be_mirrored():
    run = without_gyroscope(without_yaw(FAULTS["treads_swapped"](turning_all_round())))
    (found,) = check_recording(run).at(Level.WARNING)
    assert "cannot be distinguished" in found.cause
    assert "treads are swapped" in found.cause


def test_turns_of_the_course_are_those_of_the_gyroscope():
    evidence = Evidence(without_yaw(turning_all_round()))
    turn, by_gyroscope = evidence.pose_turn_rad, evidence.turn_motion.gyroscope_rad
    known = np.isfinite(turn)
    assert known.mean() > 0.8
    assert np.median(np.abs(turn - by_gyroscope)[known]) < 0.05
    there_and_back = replace(evidence.motion, moved_m=-evidence.motion.moved_m)
    found, same = (
        course_turns(motion, evidence.integrals, evidence.run.robot.track_width)[1]
        for motion in (evidence.motion, there_and_back)
    )
    assert same == pytest.approx(found, nan_ok=True)


@pytest.mark.parametrize("hz", [10.0, 2.5])
@pytest.mark.parametrize("with_gyroscope", [True, False])
def test_u_turns_on_the_spot_are_no_turns_to_the_other_side(with_gyroscope, hz):
    """Straight lanes with turns by 155 degrees between them, forwards and back as one course."""
    rows = []
    for lane in range(12):
        side = 1.0 if lane % 4 < 2 else -1.0
        rows += [(0.8, 0.0)] * 220 + [(0.1, 0.9 * side)] * 60 + [(0.5, 0.0)] * 20
    speed, rate = (
        np.convolve(column, np.full(15, 1 / 15), "same") for column in np.transpose(rows)
    )
    run = without_yaw(drive(speed, rate, sigma_m=0.01))
    run = replace(run, pose=run.pose.rows(slice(None, None, round(10.0 / hz))))
    assert warnings(run if with_gyroscope else without_gyroscope(run)) == []


def test_turns_that_go_with_nothing_are_not_used():
    noise = np.random.default_rng(0).normal(0, 0.4, 4000)
    run = gyroscope(without_yaw(turning_all_round()), lambda _: noise)
    assert np.isnan(Evidence(run).pose_turn_rad).all()


@pytest.mark.parametrize(("delay_s", "word"), [(0.7, "late"), (-0.7, "early")])
@pytest.mark.parametrize("with_gyroscope", [True, False])
def test_late_positions_are_named_by_their_path_or_their_speed(delay_s, word, with_gyroscope):
    run = starts_and_stops(delay_s, 1.0, 0.05)
    (found,) = check_recording(run if with_gyroscope else without_gyroscope(run)).at(Level.WARNING)
    assert (found.name, found.seen.split(" s ")[1].split()[0].strip(":")) == ("pose_late", word)
    assert float(found.remedy.lower().split("subtract ")[1].split()[0]) == pytest.approx(
        delay_s, abs=0.2
    )
    by_speed = "or the robot itself follows later" in found.cause
    assert by_speed == (delay_s > 0 and not with_gyroscope)


def test_a_short_delay_is_named_beside_a_gyroscope_that_is_in_step_with_the_treads():
    run = starts_and_stops(0.3, 5.0, 0.02)
    (found,) = check_recording(run).at(Level.WARNING)
    assert found.name == "pose_late"
    named_s = float(found.remedy.split("Subtract ")[1].split()[0])
    assert named_s == pytest.approx(0.3, abs=0.07)
    assert check_recording(without_gyroscope(run)).at(Level.WARNING) == ()
    late_gyroscope = put(run, "odometry", gyro_z=np.roll(run.odometry["gyro_z"], 6))
    assert "pose_late" not in warnings(late_gyroscope)


@pytest.mark.parametrize(("hz", "seed"), [(1.0, 0), (5.0, 1), (1.0, 2)])
def test_positions_on_time_are_not_late(hz, seed):
    report = check_recording(starts_and_stops(0.0, hz, 0.05, seed))
    assert report.at(Level.WARNING) == ()
    assert "poses without yaw: headings were not checked against them" in report.skipped


def test_where_the_speed_is_constant_delays_are_not_checked():
    run = without_yaw(drive(np.full(4000, 0.7), np.full(4000, 0.1)))
    skipped = check_recording(run).skipped
    assert "poses without yaw: headings and delays were not checked against them" in skipped


@pytest.mark.parametrize("origin", [None, [48.1, 11.5]])
def test_mirrored_positions_of_a_receiver_are_exchanged_columns(origin):
    run = without_yaw(turning_all_round())
    source = {} if origin is None else {"source": {"origin": origin}}
    run = replace(run, settings={**run.settings, **source})
    run = put(run, "pose", x=run.pose["y"], y=run.pose["x"])
    (found,) = check_recording(run).at(Level.WARNING)
    assert found.name == "pose_mirrored"
    assert ("latitude and longitude are exchanged" in found.line) == (origin is not None)


@pytest.mark.parametrize("name", ["x", "y"])
@pytest.mark.parametrize("gyro", [True, False])
def test_a_column_that_never_changes_was_not_measured(name, gyro):
    run = without_yaw(turning_all_round())
    run = put(run, "pose", **{name: np.full(len(run.pose), 3.7)})
    (found,) = check_recording(run if gyro else without_gyroscope(run)).at(Level.WARNING)
    assert found.name == "position_axes"
    assert f"{name} of pose.csv never changes" in found.seen


def test_a_lane_there_and_back_on_an_axis_is_measured():
    goes = np.repeat([1.0, 0.0, 1.0, 0.0, 1.0, 0.0, 1.0, 0.0], 500)
    run = drive(0.5 * goes, 0.1256637 * (1 - goes))
    run = put(run, "pose", y=np.zeros(len(run.pose)))
    assert "position_axes" not in warnings(without_yaw(run))
