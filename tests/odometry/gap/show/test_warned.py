"""What the check warns of stands beside the answer of the gap."""

from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

from odometry.checks.findings.finding import CheckReport, Finding, Level
from odometry.checks.findings.warned import faults_of, faults_words
from odometry.effects.commands.late_treads import ActuatorLag
from odometry.effects.interface.corrected import Added
from odometry.effects.measurement.gyroscope_error import GyroscopeError
from odometry.gap.answer.result import NamedEffect
from odometry.gap.show.advice import faults_of_sensors
from odometry.gap.show.files import content_of
from odometry.gap.show.lead import lead
from odometry.gap.show.words import sentences
from odometry.report.gap.gap_page import write_gap_report


def report(run, name, level=Level.WARNING):
    return CheckReport(Path("runs") / run, (Finding(name, level, "seen", "cause", "remedy"),))


LATE = faults_of([report("grass", "pose_late"), report("yard", "pose_late")])


def test_warnings_of_all_runs_and_notes_of_a_side_that_reads_more_count_once():
    twice = [report("grass", "pose_late"), report("grass", "pose_late")]
    notes = [report("yard", "gyroscope_bias", Level.NOTE), report("yard", "straight_drives")]
    found = faults_of([*twice, *notes])
    assert [(run, one.name) for run, one in found] == [
        ("grass", "pose_late"),
        ("yard", "straight_drives"),
    ]


def test_a_name_beside_a_warning_is_a_sensor_or_the_robot(scaled_result):
    assert lead(scaled_result)[0].startswith("Missing in icr: wheels of another size")
    said = sentences(replace(scaled_result, faults=LATE))
    assert said[0].startswith("A sensor or the robot: wheels of another size")
    assert said[0].endswith(
        "pose_late, of which check warns in these recordings, may have the same effect."
    )
    assert said[2].startswith("First correct what check warns of")
    assert "If it is wheel_scale: " in said[2]
    assert said[3] == (
        "Check warns: poses late or early, by stamps or a filter (pose_late, grass, yard)."
    )


def test_true_slip_accuses_no_sensor_and_is_said(scaled_result):
    said = sentences(replace(scaled_result, faults=faults_of([report("ice", "slip")])))
    assert said[0] == lead(scaled_result)[0]
    assert said[3].startswith("Check warns: the robot moves far less than its treads")


def test_columns_of_commands_do_not_contradict_an_effect_of_the_drive(scaled_result):
    faults = faults_of([report("grass", "treads_are_commands")])
    one = np.array([0.2])
    lag = NamedEffect(Added(ActuatorLag(), one), one, one, 0.2, 0.1, 50.0)
    lagging = replace(scaled_result, verdict="actuator_lag", effects=(lag,), faults=faults)
    said = sentences(lagging)
    assert said[0].startswith("Missing in icr: ")
    assert "First correct" not in said[2]
    assert "Check warns: " in said[3]
    scaled = sentences(replace(scaled_result, faults=faults))
    assert scaled[0].startswith("A sensor or the robot: ")


def test_a_gyroscope_of_another_scale_is_noted_and_does_not_contradict_its_own_name(scaled_result):
    faults = faults_of([report("grass", "gyroscope_scale", Level.NOTE)])
    wrong = NamedEffect(Added(GyroscopeError(), np.array([1.08, 0.0])), *[np.zeros(2)] * 2, 1, 1, 9)
    named = replace(scaled_result, verdict="gyroscope_error", effects=(wrong,), faults=faults)
    assert faults_of_sensors(named) == []
    assert faults_of_sensors(replace(scaled_result, faults=faults)) == ["gyroscope_scale"]


@pytest.mark.parametrize("name", ["none_result", "unknown_result"])
def test_it_is_said_beside_every_answer(request, name):
    result = request.getfixturevalue(name)
    said = sentences(replace(result, faults=LATE))
    assert said[0] == lead(result)[0]
    assert "Check warns: " in said[3]
    assert faults_words(result.faults) == ""
    assert "Check warns" not in " ".join(sentences(result))


def test_the_file_and_the_page_hold_it(scaled_result, tmp_path):
    result = replace(scaled_result, faults=LATE)
    kept = content_of(result)["faults"]
    assert [(one["run"], one["name"], one["cause"]) for one in kept] == [
        ("grass", "pose_late", "cause"),
        ("yard", "pose_late", "cause"),
    ]
    assert content_of(scaled_result)["faults"] == []
    write_gap_report(result, tmp_path)
    page = (tmp_path / "report.html").read_text(encoding="utf-8")
    assert page.count("Check warns: ") == 1
