"""Each cause that is named passes a test that its rivals fail."""

from dataclasses import replace

import numpy as np
import pytest

from odometry.checks.evidence.evidence import Evidence
from odometry.checks.findings.finding import Level
from odometry.checks.poses.position_axes import position_axes
from odometry.checks.recording import check_recording
from odometry.checks.treads.tread_motion import tread_motion
from odometry.checks.turns.turns_in_parts import turns_flip
from odometry.checks.unexplained.scale_drift import scale_drifts
from tests.odometry.checks.drives import PERIOD_S, drive, turning_all_round
from tests.odometry.checks.faulty import gyroscope, positions, put, treads, without_gyroscope, yaw


def warnings(run):
    return {finding.name: finding for finding in check_recording(run).at(Level.WARNING)}


def second_part(run, table="odometry", since=0.5):
    """Rows of the second half."""
    stamps_s = getattr(run, table)["t"]
    return stamps_s > stamps_s[0] + since * np.ptp(stamps_s)


def played_backwards(run):
    """All stamps reversed, values as they were."""
    end_s = run.odometry["t"][-1]
    backwards = {}
    for name in ("odometry", "pose"):
        columns = getattr(run, name).columns
        backwards[name] = {key: values[::-1] for key, values in columns.items()}
        backwards[name]["t"] = end_s - backwards[name]["t"]
    run = put(run, "odometry", **backwards["odometry"])
    return put(run, "pose", **backwards["pose"])


def test_poses_that_run_backwards_are_in_no_frame_with_z_down():
    (found,) = warnings(played_backwards(turning_all_round())).values()
    assert found.name == "sensors_disagree"
    assert "opposite to its yaw" in found.seen


def test_a_frame_with_z_down_is_still_named():
    run = yaw(positions(turning_all_round(), lambda x, y: (x, -y)), np.negative)
    assert list(warnings(run)) == ["pose_mirrored"]


def test_gyroscope_and_yaw_that_are_clockwise_beside_positions_that_are_right():
    run = turning_all_round()
    run = yaw(gyroscope(run, np.negative), np.negative)
    (found,) = warnings(run).values()
    assert found.name == "yaw_reversed"
    assert "Yaw and gyro_z are clockwise" in found.cause
    assert "treads are swapped, and positions are mirrored" in found.cause


def integrated_in_the_robots_frame(run):
    """Positions that were never turned by yaw."""
    dx, dy = (np.diff(run.pose[name], prepend=run.pose[name][0]) for name in ("x", "y"))
    cos, sin = np.cos(run.pose["yaw"]), np.sin(run.pose["yaw"])
    return put(run, "pose", x=np.cumsum(cos * dx + sin * dy), y=np.cumsum(cos * dy - sin * dx))


@pytest.mark.parametrize("sensors", [lambda run: run, without_gyroscope])
def test_positions_that_were_never_turned_by_yaw_are_a_disagreement(sensors):
    run = integrated_in_the_robots_frame(sensors(turning_all_round()))
    assert list(position_axes(Evidence(run))) == []
    assert list(warnings(run)) == ["sensors_disagree"]


def test_axes_of_which_one_is_exchanged_in_a_half_are_a_disagreement():
    run = turning_all_round()
    late = second_part(run, "pose")
    x, y = run.pose["x"], run.pose["y"]
    middle = [values[late][0] for values in (x, y)]
    run = put(
        run,
        "pose",
        x=np.where(late, middle[0] + y - middle[1], x),
        y=np.where(late, middle[1] + x - middle[0], y),
    )
    assert "sensors_disagree" in warnings(run)


@pytest.mark.parametrize("rate_rad_s", [0.03, -0.05])
def test_yaw_that_drifts_against_course_and_gyroscope_is_named(rate_rad_s):
    run = turning_all_round()
    drifting = put(run, "pose", yaw=run.pose["yaw"] + rate_rad_s * run.pose["t"])
    (found,) = check_recording(drifting).findings
    assert found.name == "yaw_drifts"
    assert f"{rate_rad_s:+.3f}"[:5] in found.seen
    left = np.angle(np.exp(1j * (found.mend(drifting).pose["yaw"] - run.pose["yaw"])))
    assert np.ptp(np.unwrap(left)) < 0.3  # of 6 and 10


def test_yaw_and_gyroscope_that_drift_together_are_a_disagreement():
    run = gyroscope(turning_all_round(), lambda rate: rate + 0.06)
    run = put(run, "pose", yaw=run.pose["yaw"] + 0.06 * run.pose["t"])
    (found,) = warnings(run).values()
    assert found.name == "sensors_disagree"


def test_poses_that_turn_against_a_gyroscope_that_is_right_at_rest():
    """A map that turns slowly: course and yaw agree."""
    run = turning_all_round()
    stays = (run.odometry["t"] > 60) & (run.odometry["t"] < 70)
    at_rest = (run.pose["t"] > 60) & (run.pose["t"] < 70)
    run = treads(run, lambda left, right: (np.where(stays, 0, left), np.where(stays, 0, right)))
    run = gyroscope(run, lambda rate: np.where(stays, 0.001 * np.sin(run.odometry["t"]), rate))
    step = np.diff(run.pose["x"] + 1j * run.pose["y"], prepend=0)
    turned = np.where(at_rest, 0, np.diff(np.unwrap(run.pose["yaw"]), prepend=0))
    angle, drift = np.cumsum(turned), 0.03 * run.pose["t"]
    change = angle - np.unwrap(run.pose["yaw"])
    path = np.cumsum(np.where(at_rest, 0, step) * np.exp(1j * (change + drift)))
    run = put(run, "pose", x=path.real, y=path.imag, yaw=angle + drift)
    (found,) = warnings(run).values()
    assert found.name == "sensors_disagree"
    assert "at rest" in found.seen


def test_an_offset_of_yaw_must_hold_at_every_place():
    run = turning_all_round()
    assert list(warnings(yaw(run, lambda angle: angle + 0.35))) == ["yaw_offset"]
    x = run.pose["x"]
    twisted = put(run, "pose", yaw=run.pose["yaw"] + 0.8 * (x - x.min()) / np.ptp(x))
    assert "yaw_offset" not in warnings(twisted)


def test_treads_that_are_exchanged_in_a_part_have_no_cause_of_the_whole():
    run = turning_all_round()
    late = second_part(run, since=0.7)
    run = treads(
        run, lambda left, right: (np.where(late, right, left), np.where(late, left, right))
    )
    assert turns_flip(Evidence(run))
    (found,) = warnings(run).values()
    assert found.name == "changed_in_part"
    assert found.cause.endswith("s on left and right treads are exchanged")
    assert found.spans_s[0][0] == pytest.approx(0.7 * np.ptp(run.odometry["t"]), abs=0.5)


def test_gyroscope_that_holds_the_change_of_the_turn_makes_no_counters():
    run = turning_all_round()
    rate = run.odometry["gyro_z"]
    smooth = np.convolve(rate, np.ones(5) / 5, mode="same")
    run = replace(put(run, "odometry", gyro_z=np.gradient(smooth, run.odometry["t"])))
    assert not [f for f in tread_motion(Evidence(run)) if f.name == "treads_are_counters"]


def test_a_dead_zone_of_the_gyroscope_is_one():
    run = gyroscope(turning_all_round(), lambda rate: np.where(np.abs(rate) < 0.3, 0.0, rate))
    (found,) = warnings(run).values()
    assert found.name == "gyroscope_dead"
    assert "dead zone: slower turns than 0.3 rad/s" in found.cause


def test_yaw_that_wanders_is_not_late():
    run = turning_all_round()
    rng = np.random.default_rng(3)
    wander = np.convolve(rng.normal(0, 1, len(run.pose)), np.exp(-np.arange(300) / 100))[
        : len(run.pose)
    ]
    run = put(run, "pose", yaw=run.pose["yaw"] + 0.4 * wander / wander.std())
    assert not {"pose_late", "clocks_apart"} & set(warnings(run))


def test_a_gyroscope_that_lost_its_sign_holds_a_size():
    (found,) = warnings(gyroscope(turning_all_round(), np.abs)).values()
    assert found.name == "gyroscope_unrelated"
    assert "its sign was lost" in found.cause


def test_a_drive_that_turns_to_one_side_lost_no_sign():
    at_s = PERIOD_S * np.arange(2400)
    run = drive(np.full(2400, 0.8), np.maximum(0.4 * np.sin(at_s / 5), 0), yaw_sigma=0.01)
    run = gyroscope(run, lambda rate: np.maximum(rate, 0))
    assert "gyroscope_unrelated" not in warnings(run)


def test_a_scale_of_the_treads_that_drifts_is_a_disagreement():
    run = turning_all_round()
    drift = np.linspace(1, 1.7, len(run.odometry))
    run = treads(run, lambda left, right: (drift * left, drift * right))
    assert scale_drifts(Evidence(run))
    assert "sensors_disagree" in warnings(run)
    assert not scale_drifts(Evidence(turning_all_round()))


def test_yaw_that_is_half_accuses_no_gyroscope():
    run = turning_all_round()
    run = yaw(run, lambda angle: np.unwrap(angle) / 2)
    (found,) = warnings(run).values()
    assert found.name == "yaw_is_quaternion"
    assert "half of the right one" in found.cause


def test_treads_exchanged_for_a_part_of_a_circle_look_like_a_lost_sign_without_poses():
    run = drive(np.full(1600, 0.8), np.full(1600, 0.5))
    late = second_part(run)
    run = treads(
        run, lambda left, right: (np.where(late, right, left), np.where(late, left, right))
    )
    assert "gyroscope_unrelated" not in warnings(run)
    (found,) = warnings(replace(run, pose=None)).values()
    assert "treads are exchanged for a part" in found.cause
