"""Poses that a filter smoothed are found; those that were measured are not taken for such."""

from dataclasses import replace

import numpy as np
import pytest

from odometry.checks.evidence.evidence import Evidence
from odometry.checks.findings.finding import Level
from odometry.checks.poses.smoothed_poses import smoothed_poses
from odometry.checks.recording import check_recording
from tests.odometry.checks.drives import winding
from tests.odometry.checks.faulty import put


def smoothed(run, seconds, names=("x", "y", "yaw")):
    """A moving mean over poses at 10 Hz."""
    half = round(10 * seconds) // 2
    kernel = np.ones(2 * half + 1) / (2 * half + 1)
    columns = {n: np.unwrap(run.pose[n]) if n == "yaw" else run.pose[n] for n in names}
    return put(
        run,
        "pose",
        **{n: np.convolve(np.pad(c, half, "edge"), kernel, "valid") for n, c in columns.items()},
    )


def without_yaw(run):
    return put(run, "pose", yaw=np.full(len(run.pose), np.nan))


def found_in(run):
    return list(smoothed_poses(Evidence(run)))


@pytest.mark.parametrize("alter", [lambda run: run, without_yaw], ids=["poses", "positions"])
def test_measured_poses_are_not_smooth(alter):
    assert found_in(alter(winding())) == []


@pytest.mark.parametrize("seconds", [1.4, 2.0, 3.0])
@pytest.mark.parametrize("alter", [lambda run: run, without_yaw], ids=["poses", "positions"])
def test_smoothed_poses_are_found_with_the_time(alter, seconds):
    (finding,) = found_in(alter(smoothed(winding(), seconds)))
    assert finding.level is Level.WARNING
    over_s = float(finding.seen.split()[-2])
    assert over_s == pytest.approx(seconds, rel=0.2)
    assert "cut corners short" in finding.cause


@pytest.mark.parametrize("first_s", [1.0, 25.0])
def test_a_gyroscope_that_starts_later_than_the_poses_is_compared_from_there_on(first_s):
    """Not measured before: no number there, and every sum from the start would be none."""
    run = smoothed(winding(), 2.0)
    of = run.odometry
    gyro_z = np.where(of.stamps_s - of.stamps_s[0] < first_s, np.nan, of["gyro_z"])
    assert [one.name for one in found_in(put(run, "odometry", gyro_z=gyro_z))] == ["smoothed_poses"]


def test_positions_that_are_smooth_beside_a_sharp_yaw_are_something_else():
    assert found_in(smoothed(winding(), 2.0, ("x", "y"))) == []


def test_the_check_names_them_first():
    assert check_recording(smoothed(winding(), 2.0)).findings[0].name == "smoothed_poses"


def test_late_poses_are_named_as_late():
    """A filter that looks back alone: what is late looks smooth as well."""
    run = smoothed(winding(), 2.0)
    late = put(run, "pose", t=run.pose["t"] + 0.7)
    assert [one.name for one in found_in(late)] == ["smoothed_poses"]
    assert [one.name for one in check_recording(late).findings] == ["pose_late"]


def test_without_a_gyroscope_nothing_is_said():
    run = smoothed(winding(), 2.0)
    columns = {n: c for n, c in run.odometry.columns.items() if n != "gyro_z"}
    assert found_in(replace(run, odometry=replace(run.odometry, columns=columns))) == []


def test_a_short_recording_is_not_judged():
    run = smoothed(winding(), 2.0)
    rows = np.flatnonzero(run.odometry.stamps_s < 50)
    assert found_in(replace(run, odometry=run.odometry.rows(rows))) == []
