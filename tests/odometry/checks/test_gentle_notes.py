"""Notes of outages and names of columns, and paths that are no run folder."""

import numpy as np
import pytest

from odometry.checks.evidence.evidence import Evidence
from odometry.checks.findings.finding import Level
from odometry.checks.recording import check_recording
from odometry.checks.settings.settings import columns
from tests.odometry.checks.drives import winding
from tests.odometry.checks.faulty import gyroscope, without_gyroscope
from tests.odometry.checks.test_odd_input import DRIVES, changed, drive, table, with_imu


def names(run):
    return [finding.name for finding in check_recording(run).findings]


def with_poses(run, kept):
    return changed(run, "pose", **{n: c[kept] for n, c in run.pose.columns.items()})


def test_an_outage_of_the_poses_is_a_note():
    run = winding()
    lost = (run.pose["t"] > 40) & (run.pose["t"] < 60)
    (found,) = check_recording(with_poses(run, ~lost)).findings
    assert (found.name, found.level) == ("pose_outage", Level.NOTE)
    assert "for 20.0 s" in found.seen
    assert found.spans_s[0] == pytest.approx((40.0, 60.0), abs=0.11)


@pytest.mark.parametrize("name", ["wz", "gyroz", "Gyro Z", "yaw_rate", "angular_velocity_z"])
def test_a_gyroscope_by_another_name_is_a_note(name):
    run = winding()
    renamed = changed(without_gyroscope(run), "odometry", **{name: run.odometry["gyro_z"]})
    (found,) = columns(Evidence(renamed))
    assert (found.name, found.level) == ("column_name", Level.NOTE)
    assert "'gyro_z'" in found.seen
    if name == "wz":
        assert check_recording(renamed).findings == (found,)


def test_other_columns_are_not_mentioned():
    run = winding()
    more = np.ones(len(run.odometry))
    assert names(changed(run, "odometry", battery=more, wz=more, joystick=more)) == []
    rates = run.odometry["gyro_z"]
    in_imu = with_imu(changed(without_gyroscope(run), "odometry", wz=rates), gyro_z=0.0)
    assert "column_name" not in names(in_imu)


def test_yaw_does_not_jump_in_a_gap_of_the_odometry():
    run = drive(2400, *DRIVES["curves"])
    noise = np.random.default_rng(0).normal(0, 0.01, (3, 2400))
    columns = zip(("x", "y", "yaw"), noise, strict=True)
    run = changed(run, "pose", **{name: run.pose[name] + n for name, n in columns})
    kept = np.abs(run.odometry["t"] - 60) > 4
    cut = changed(run, "odometry", **{n: c[kept] for n, c in run.odometry.columns.items()})
    assert "odometry_gap" in names(cut)
    assert "yaw_jumps" not in names(cut)


def test_a_robot_that_turned_on_the_spot_in_a_gap_did_not_set_its_clock():
    run = drive(2400, *DRIVES["curves"])
    kept = np.abs(run.odometry["t"] - 60) > 4
    cut = changed(run, "odometry", **{n: c[kept] for n, c in run.odometry.columns.items()})
    t = cut.odometry["t"]
    before, after = (np.interp(s, run.pose["t"], run.pose["x"]) for s in (56, 64))
    late = run.pose["t"] > 64
    pose = {n: np.where(late, run.pose[n] - (after - before), run.pose[n]) for n in ("x",)}
    outside = (run.pose["t"] < 56) | late
    poses = table({"t": run.pose["t"], "y": run.pose["y"], "yaw": run.pose["yaw"] + late, **pose})
    turned = changed(cut, "pose", **{n: c[outside] for n, c in poses.columns.items()})
    assert "clock_set" not in names(turned)
    assert len(t) < 2400


@pytest.mark.parametrize(
    ("made", "words"),
    [
        ("drive.mcap", "this is a bag"),
        ("drive.bag", "this is a bag"),
        ("ros2/drive_0.db3", "this is a bag"),
        ("notes.txt", "this is a file"),
        ("notes/text.txt", "no run.toml"),
        ("runs/first/run.toml", "1 in it have one (first)"),
        ("", "no such folder"),
    ],
)
def test_what_is_no_run_folder_is_said_in_one_line(tmp_path, made, words):
    if made:
        (tmp_path / made).parent.mkdir(parents=True, exist_ok=True)
        (tmp_path / made).write_text("")
    given = tmp_path / (made.split("/")[0] or "nothing")
    (found,) = check_recording(given).findings
    assert (found.name, found.level) == ("no_run_folder", Level.REFUSED)
    assert words in found.line
    assert "\n" not in found.line


@pytest.mark.parametrize("factor", [0.94, 1.08])
def test_a_gyroscope_that_is_wrong_by_some_percent_is_a_note(factor):
    (found,) = check_recording(gyroscope(winding(), lambda rate: factor * rate)).findings
    assert (found.name, found.level) == ("gyroscope_scale", Level.NOTE)
    ratio = float(found.remedy.split("gyro_z by ")[1].split()[0])
    assert ratio == pytest.approx(1 / factor, abs=0.005)
    assert ("tilted" in found.cause) == (factor < 1)


@pytest.mark.parametrize("factor", [0.98, 1.02])
def test_a_gyroscope_that_is_wrong_by_little_is_not_mentioned(factor):
    assert names(gyroscope(winding(), lambda rate: factor * rate)) == []


def test_a_gyroscope_that_is_noisy_is_not_called_wrong():
    noise = np.random.default_rng(0).normal(0, 0.3, len(winding().odometry))
    assert "gyroscope_scale" not in names(gyroscope(winding(), lambda rate: rate + noise))
