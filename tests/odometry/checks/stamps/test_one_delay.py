"""A sensor that is late by one delay; filters, clocks and two sources that only seem so."""

import re

import numpy as np
import pytest

from odometry.checks.evidence.evidence import Evidence
from odometry.checks.findings.undo import TREADS
from odometry.checks.recording import check_recording
from odometry.checks.stamps.explained_lags import UNDECIDED
from odometry.checks.stamps.late_stamps import followed
from odometry.checks.stamps.one_delay import Answer, answers
from odometry.checks.stamps.timing import lags_of
from tests.odometry.checks.drives import PERIOD_S, drive, stepping, winding
from tests.odometry.checks.faulty import later, pose_stamps, put, without_gyroscope, yaw


def behind_a_filter(values, constant_s, period_s=PERIOD_S):
    keeps, slow = np.exp(-period_s / constant_s), np.array(values, dtype=float)
    for row in range(1, len(slow)):
        slow[row] = keeps * slow[row - 1] + (1 - keeps) * slow[row]
    return slow


def first(run):
    return check_recording(run).findings[0]


@pytest.mark.parametrize(
    ("name", "found", "seed"), [("gyro_z", "gyroscope", 0), ("treads", "treads", 1)]
)
def test_what_is_smoothed_is_slower_and_not_late_stamps(name, found, seed):
    run = stepping(seed)
    names = ("gyro_z",) if name == "gyro_z" else TREADS
    slow = {name: behind_a_filter(run.odometry[name], 0.4) for name in names}
    finding = first(put(run, "odometry", **slow))
    assert finding.name == f"{found}_late"
    assert finding.cause.startswith(f"Turns of the {found} follow those of the")
    assert re.search("low-pass filter of about 0.[45] s", finding.cause)
    assert "Subtract" not in finding.remedy


@pytest.mark.parametrize(
    ("names", "found", "seed"), [(("gyro_z",), "gyroscope", 0), (TREADS, "treads", 1)]
)
def test_what_is_late_by_one_delay_is_late_stamps(names, found, seed):
    finding = first(later(stepping(seed), names, 0.4))
    assert finding.name == f"{found}_late"
    assert finding.cause.startswith(f"Stamps of {found} are late")


def test_noise_of_the_earlier_sensor_does_not_make_the_other_slower():
    run = later(stepping(yaw_sigma=0.04), ("gyro_z",), 0.4)
    evidence = Evidence(run)
    of_pose = [a for a in answers(evidence, "gyroscope", lags_of(evidence)) if a.early == "poses"]
    assert of_pose[0].slower < 0.9  # a filter averages the noise of the poses
    assert not of_pose[0].is_slower
    assert first(run).cause.startswith("Stamps of gyroscope are late")


@pytest.mark.parametrize(("left", "slower"), [(1e-4, False), (1e-2, True)])
def test_where_one_delay_leaves_next_to_nothing_no_filter_explains_more(left, slower):
    of = Answer("treads", "poses", left, 0.5, 1.0, 0.3, 1.0, 0.0, 0.0, 0.0)
    assert of.is_slower is slower


def test_turns_too_smooth_to_decide_say_so():
    assert first(later(winding(), ("gyro_z",), 0.4)).cause.startswith(UNDECIDED + "stamps of gyro")


def test_rows_of_two_sources_are_no_late_stamps():
    run = stepping()
    late = later(run, TREADS, 0.7)
    mixed = {name: run.odometry[name].copy() for name in TREADS}
    for name in TREADS:
        mixed[name][::2] = late.odometry[name][::2]
    finding = first(put(run, "odometry", **mixed))
    assert not finding.cause.startswith("Stamps")


def test_a_clock_that_was_set_is_no_delay():
    run = pose_stamps(stepping(), lambda t: t + 0.5 * (t > 30))
    finding = first(run)
    assert finding.name == "clock_set"
    assert re.search("step by [+]0.50 s .* at about (29|3[01]) s of run time", finding.seen)


def test_a_yaw_that_is_smoothed_alone_makes_no_commands_of_the_treads():
    run = without_gyroscope(stepping())
    slow = yaw(run, lambda angle: behind_a_filter(np.unwrap(angle), 0.3, 2 * PERIOD_S))
    finding = first(slow)
    assert finding.name == "sensors_disagree"
    assert "turns alone are late" in finding.seen


def test_a_robot_that_follows_later_has_commands_for_treads():
    run = without_gyroscope(stepping())
    wheels = followed(0.5)(run)  # and what was logged is what the drive was asked for
    measured = drive(*twist(wheels))
    assert first(put(run, "pose", **measured.pose.columns)).name == "treads_are_commands"


def twist(run):
    left, right = (0.93 * run.odometry[name] for name in TREADS)
    return (left + right) / 2, (right - left) / 0.9
