"""Yaw that has another offset to the course in each piece of a recording, and robots that skid."""

import numpy as np

from odometry.checks.evidence.evidence import Evidence
from odometry.checks.poses.course_offsets import yaw_wanders
from tests.odometry.checks.drives import PERIOD_S, drive, winding
from tests.odometry.checks.faulty import put, yaw


def turning_by_pieces():
    """Slow circles to the left and to the right, 20 s each."""
    side = np.sign(np.sin(np.pi * PERIOD_S * np.arange(3200) / 20 + 1e-6))
    return drive(np.full(3200, 0.3), 0.35 * side)


def skidding(run, arm_m):
    """The same of a robot that turns about a point behind its origin."""
    heading = run.pose["yaw"]
    return put(
        run,
        "pose",
        x=run.pose["x"] + arm_m * np.cos(heading),
        y=run.pose["y"] + arm_m * np.sin(heading),
    )


def test_a_robot_that_skids_in_tight_turns_has_the_same_yaw_in_each_piece():
    """Its course is 17 degrees off its yaw, to one side in half of the pieces."""
    assert yaw_wanders(Evidence(skidding(turning_by_pieces(), 0.25))) == ""


def test_a_robot_that_skids_and_drives_straight_has_it_as_well():
    """Offsets are those of the straight half of each piece, which do not skid."""
    at_s = PERIOD_S * np.arange(3200)
    turns = np.where(at_s % 20 < 10, 0.0, 0.8 * np.sign(np.sin(np.pi * at_s / 20 + 1e-6)))
    run = drive(np.full(3200, 0.3), turns)
    assert yaw_wanders(Evidence(skidding(run, 0.25))) == ""
    assert yaw_wanders(Evidence(skidding(run, 0.4))) == ""


def test_a_robot_that_stands_and_spins_in_exact_data_divides_by_nothing():
    at_s = PERIOD_S * np.arange(3200)
    stops = at_s % 20 < 5
    run = drive(np.where(stops, 0.0, 0.5), np.where(at_s % 20 < 3, 0.6, 0.0), sigma_m=0.0)
    with np.errstate(divide="raise"):
        assert yaw_wanders(Evidence(run)) == ""


def test_a_yaw_that_drifts_to_and_fro_wanders():
    for run in (winding(), skidding(turning_by_pieces(), 0.25)):
        slow = 0.4 * np.sin(run.pose["t"] / 15)
        said = yaw_wanders(Evidence(yaw(run, lambda angle, slow=slow: angle + slow)))
        assert "in pieces of the recording" in said
