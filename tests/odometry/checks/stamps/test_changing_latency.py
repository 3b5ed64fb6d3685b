"""Latencies that drift, step or wander within a recording."""

from dataclasses import replace

import numpy as np
import pytest

from odometry.checks.evidence.evidence import Evidence
from odometry.checks.findings.finding import Level
from odometry.checks.recording import check_recording
from odometry.checks.stamps.latencies import changing
from odometry.estimation.config import IcrEkfConfig
from odometry.preparation.pose_delay import without_pose_delay
from odometry.recording.run import Run
from tests.odometry.checks.answers import warnings
from tests.odometry.checks.drives import stepping, turning_all_round
from tests.odometry.checks.faulty import pose_stamps, put


def fills(most_s, begin_s=60.0, within_s=30.0):
    """A latency that grows from a moment and stays at its largest."""
    return lambda t: most_s * (1 - np.exp(-np.maximum(t - t[0] - begin_s, 0) / within_s))


def later(run, late_s):
    return pose_stamps(run, lambda t: t + late_s(t))


def of_gyroscope(run, late_s):
    """The yaw rate as it was so much earlier."""
    t = run.odometry.stamps_s
    return put(run, "odometry", gyro_z=np.interp(t - late_s(t), t, run.odometry["gyro_z"]))


@pytest.mark.parametrize(
    ("change", "odd"), [(later, "poses"), (of_gyroscope, "gyroscope")], ids=["pose", "gyroscope"]
)
def test_a_latency_that_grows_is_named_with_whose_it_is(change, odd):
    (found,) = check_recording(change(stepping(), fills(0.5))).at(Level.WARNING)
    assert found.name == "latency_changes"
    assert found.cause.startswith(f"Stamps of {odd} are late by a time that changes")


def test_what_is_named_can_be_undone():
    (found,) = check_recording(later(stepping(), fills(0.5))).at(Level.WARNING)
    assert warnings(found.mend(later(stepping(), fills(0.5)))) == []


@pytest.mark.parametrize("late_s", [0.0, 0.4])
def test_a_constant_latency_does_not_change(late_s):
    assert changing(Evidence(pose_stamps(stepping(), lambda t: t + late_s))) is None


def test_without_a_third_sensor_nobody_is_accused_alone():
    run = replace(turning_all_round(), pose=None)
    found = changing(Evidence(of_gyroscope(run, fills(0.8))))
    assert found is None or found.odd == ""


def test_run_takes_poses_at_the_stamps_of_measurement():
    true, late_s = stepping(), fills(0.5)
    run, (event,) = without_pose_delay(later(true, late_s), IcrEkfConfig())
    assert event.kind == "late_poses"
    assert "by a time that changes" in event.text
    np.testing.assert_allclose(run.pose.stamps_s, true.pose.stamps_s, atol=0.06)


@pytest.mark.parametrize("name", ["husky_2023_s04", "marmotte_boreal_20240125_1215_s00"])
def test_a_pose_computer_that_falls_behind_on_real_recordings(shared_data, name):
    run = Run.read(shared_data / "motion" / name)
    assert changing(Evidence(run)) is None
    found = [f.name for f in check_recording(later(run, fills(0.5))).findings]
    assert found[0] == "latency_changes", found
