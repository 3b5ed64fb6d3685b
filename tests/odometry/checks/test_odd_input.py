"""The check says something, or nothing, of every recording that the format allows."""

from dataclasses import replace
from itertools import product
from pathlib import Path

import numpy as np
import pytest

from odometry.checks.evidence.evidence import Evidence
from odometry.checks.evidence.motion import motion_between
from odometry.checks.findings.catalogue import CATALOGUE
from odometry.checks.findings.consequences import CONSEQUENCES
from odometry.checks.findings.finding import Level
from odometry.checks.poses.steps import step_sizes
from odometry.checks.recording import check_recording
from odometry.recording.run import Robot, Run
from odometry.tables.table import Table

WIDTH_M = 0.9


def table(columns):
    columns = {name: np.asarray(column, dtype=np.float64) for name, column in columns.items()}
    return Table(Path("made.csv"), columns, np.arange(len(columns["t"])) + 2)


def drive(count, left, right, period_s=0.05):
    """A run without noise: the robot turns as if WIDTH_M wide."""
    t = period_s * np.arange(count)
    left, right = (np.broadcast_to(speed(t), count) for speed in (left, right))
    rate = (right - left) / WIDTH_M
    yaw = np.append(0.0, np.cumsum(rate[:-1] * period_s))
    steps = (left + right)[:-1] / 2 * period_s
    x, y = (np.append(0.0, np.cumsum(steps * way(yaw[:-1]))) for way in (np.cos, np.sin))
    odometry = table({"t": t, "v_left": left, "v_right": right, "gyro_z": rate})
    poses = table({"t": t, "x": x, "y": y, "yaw": np.angle(np.exp(1j * yaw))})
    return Run(Path("made"), Robot(0.6), {}, odometry, pose=poses)


DRIVES = {
    "stationary": (lambda _: 0.0, lambda _: 0.0),
    "straight": (lambda _: 0.5, lambda _: 0.5),
    "on the spot": (lambda _: -0.5, lambda _: 0.5),
    "curves": (lambda t: 0.5 + 0.3 * np.sin(0.7 * t), lambda t: 0.5 + 0.3 * np.cos(0.9 * t)),
}


def changed(run, name, **columns):
    of = getattr(run, name)
    nothing = np.full(len(of), np.nan)
    columns = {key: nothing if value is None else value for key, value in columns.items()}
    return replace(run, **{name: replace(of, columns={**of.columns, **columns})})


def with_poses(run, chosen):
    return replace(run, pose=table({n: column[chosen] for n, column in run.pose.columns.items()}))


def with_imu(run, **columns):
    t = run.odometry.stamps_s
    values = {name: np.full(len(t), value) for name, value in columns.items()}
    return replace(run, imu=table({"t": t, **values}))


ODD = {
    "as it is": lambda run: run,
    "two poses": lambda run: with_poses(run, [0, -1]),
    "one pose": lambda run: with_poses(run, [0]),
    "sparse poses": lambda run: with_poses(run, slice(None, None, 40)),
    "poses later": lambda run: changed(run, "pose", t=run.pose.stamps_s + 1e3),
    "heights alone": lambda run: changed(run, "pose", x=None, y=None, yaw=None),
    "yaw alone": lambda run: changed(run, "pose", x=None, y=None),
    "positions alone": lambda run: changed(run, "pose", yaw=None),
    "every pose a window": lambda run: changed(run, "pose", window=np.arange(len(run.pose))),
    "gyroscope all NaN": lambda run: changed(run, "odometry", gyro_z=None),
    "attitude all NaN": lambda run: changed(run, "odometry", roll=None, pitch=None),
    "accelerations all NaN": lambda run: changed(
        run,
        "odometry",
        roll=0.1 * run.pose["x"],
        pitch=0 * run.pose["x"],
        accel_x=None,
        accel_y=None,
    ),
    "imu.csv of accelerations": lambda run: with_imu(
        run, accel_x=0.0, accel_y=np.nan, accel_z=9.81
    ),
    "imu.csv of nothing": lambda run: with_imu(run, gyro_z=np.nan, accel_x=np.nan),
}


# Each number of so few rows comes with every oddity and with every drive, not with every pair.
FEW_ROWS = [
    (tuple(DRIVES)[(i + j) % len(DRIVES)], odd, count)
    for i, odd in enumerate(ODD)
    for j, count in enumerate([10, 13, 24, 60])
]


@pytest.mark.parametrize(("driven", "odd", "count"), [*product(DRIVES, ODD, [600]), *FEW_ROWS])
def test_nothing_legal_makes_it_raise(driven, odd, count):
    """Warnings of NumPy are errors here."""
    report = check_recording(ODD[odd](drive(count, *DRIVES[driven])))
    assert {finding.name for finding in report.findings} <= set(CATALOGUE)
    assert not [finding.line for finding in report.findings if " nan" in finding.line]


def test_a_rate_that_is_held_without_noise_is_neither_clipped_nor_dead():
    report = check_recording(drive(600, *DRIVES["on the spot"]))
    assert [f.name for f in report.findings if f.name.startswith("gyroscope")] == []


def test_corrupt_samples_are_looked_for_where_the_yaw_rate_is_read():
    run = drive(600, *DRIVES["curves"])
    rates = run.odometry["gyro_z"].copy()
    rates[300] = 90.0
    run = with_imu(changed(run, "odometry", gyro_z=rates), gyro_z=np.nan)
    (found,) = (f for f in check_recording(run).findings if f.name == "absurd_yaw_rate")
    assert "odometry.csv" in found.seen
    assert found.spans_s == ((15.0, 15.0),)


def test_a_clock_that_was_set_is_not_reported_as_lost_rows_too():
    run = drive(1200, *DRIVES["curves"])
    later = np.where(run.odometry.stamps_s > 30, 5.0, 0.0) + run.odometry.stamps_s
    run = changed(changed(run, "odometry", t=later), "pose", t=later)
    names = [finding.name for finding in check_recording(run).findings]
    assert "clock_set" in names
    assert "odometry_gap" not in names


def test_a_clock_that_was_set_by_years_is_refused_with_both_parts():
    """A robot that starts in 1970: grids of time over 50 years needed more memory than there is."""
    run = drive(1200, *DRIVES["curves"])
    later = np.where(run.odometry.stamps_s > 30, 1.7e9, 0.0) + run.odometry.stamps_s
    run = changed(changed(run, "odometry", t=later), "pose", t=later)
    (refused,) = check_recording(run).findings
    assert (refused.level, refused.name) == (Level.REFUSED, "clock_set")
    assert "(line 602 to 603)" in refused.seen
    assert "--to 30.000" in refused.remedy
    assert "--from 1700000030.050" in refused.remedy


def test_images_and_poses_may_be_rare():
    """One image in half a minute, as of a time-lapse; stamps in ms would lie elsewhere."""
    run = drive(6000, *DRIVES["curves"])
    rare = table({"t": np.arange(0.0, 300.0, 30.0), "x": np.zeros(10), "y": np.zeros(10)})
    report = check_recording(replace(run, truth=rare))
    assert not [finding for finding in report.findings if finding.level is Level.REFUSED]
    odd = replace(rare, columns={**rare.columns, "t": 1000 * rare.stamps_s + 1})
    (refused,) = check_recording(replace(run, truth=odd)).findings
    assert (refused.level, refused.name) == (Level.REFUSED, "stamp_unit")


def test_a_log_of_changes_may_hold_its_commands_for_long():
    held_s = np.array([4.0, 1.0, 9.0, 3.0, 20.0, 2.0, 5.0, 1.0, 12.0, 3.0, 8.0, 2.0])
    t = np.cumsum(held_s)
    speeds = np.where(np.arange(12) % 2, 0.2, 0.8)
    odometry = table({"t": t, "v_left": speeds, "v_right": speeds[::-1]})
    run = Run(Path("made"), Robot(0.6), {}, odometry)
    assert not [f for f in check_recording(run).findings if f.level is Level.REFUSED]
    even = replace(odometry, columns={**odometry.columns, "t": 50.0 * np.arange(12)})
    (refused,) = check_recording(replace(run, odometry=even)).findings
    assert refused.name == "stamp_unit"


def test_an_empty_column_window_parts_nothing():
    run = drive(600, *DRIVES["curves"])
    empty = Evidence(changed(run, "pose", window=None))
    assert len(empty.motion) == len(Evidence(run).motion) > 50


def test_consequences_are_of_the_catalogue():
    told = set(CONSEQUENCES).union(*CONSEQUENCES.values())
    assert told <= set(CATALOGUE)


def test_windows_between_poses_are_half_a_second_long():
    run = drive(600, *DRIVES["curves"], period_s=0.03)
    evidence = Evidence(run)
    motion = motion_between(run, evidence.integrals, evidence.poses_used)
    chosen = [0]  # one by one
    for row, stamp_s in enumerate(run.pose.stamps_s):
        if stamp_s - run.pose.stamps_s[chosen[-1]] >= 0.5 - 1e-6:
            chosen.append(row)
    np.testing.assert_array_equal(motion.start_s, run.pose.stamps_s[chosen[:-1]])


def test_steps_are_between_medians_of_both_sides():
    rng = np.random.default_rng(3)
    stamps_s = np.cumsum(rng.uniform(0.02, 0.12, 300))
    off = rng.normal(size=(300, 2))
    off[150:] += (3.0, 4.0)
    found = step_sizes(stamps_s, off)
    for i in (60, 150, 220):  # slices by comparison
        apart_s = stamps_s - stamps_s[i]
        before = off[(apart_s >= -1.25) & (apart_s < -0.25)]
        after = off[(apart_s >= 0.25) & (apart_s < 1.25)]
        expected = np.hypot(*(np.median(after, axis=0) - np.median(before, axis=0)))
        assert found[i] == pytest.approx(expected, rel=1e-12)
    assert np.isnan(found[[0, -1]]).all()


def test_a_missing_yaw_column_may_be_empty(tmp_path):
    (tmp_path / "run.toml").write_text("[robot]\ntrack_width = 0.5\n")
    (tmp_path / "odometry.csv").write_text("t,v_left,v_right\n0,1,1\n1,1,1\n")
    (tmp_path / "pose.csv").write_text("t,x,y\n0,1,1\n1,1,1\n")
    (refused,) = check_recording(tmp_path).findings
    assert "an empty column yaw" in refused.remedy
