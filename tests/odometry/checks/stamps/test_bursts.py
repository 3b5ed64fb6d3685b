"""Rows that come many at once, with the stamps of their arrival."""

from dataclasses import replace

import numpy as np
import pytest

from odometry.checks.findings.finding import Level
from odometry.checks.recording import check_recording
from odometry.checks.stamps.bursts import spread_bursts
from tests.odometry import arrivals
from tests.odometry.checks.drives import drive, table
from tests.odometry.checks.faulty import SENSORS


@pytest.fixture(scope="module")
def driven():
    """Two minutes of turns to both sides, 20 rows a second."""
    at_s = 0.05 * np.arange(2400)
    speed = 0.8 + 0.4 * np.sin(at_s / 5)
    return drive(speed, 0.7 * np.sin(at_s / 2.3))


def stamped(run, stamps_s, rows=slice(None), name="odometry"):
    of = getattr(run, name)
    columns = {column: np.asarray(values)[rows] for column, values in of.columns.items()}
    return replace(run, **{name: replace(of, columns={**columns, "t": stamps_s})})


def in_bursts(run, fewest, most, name="odometry"):
    """Bursts of so many rows, half a millisecond apart, from the stamp of their last row on."""
    rng, stamps_s = np.random.default_rng(fewest), getattr(run, name).stamps_s
    last = np.cumsum(rng.integers(fewest, most + 1, len(stamps_s)))
    last = np.append(last[last < len(stamps_s) - 1], len(stamps_s) - 1)
    rows = np.arange(len(stamps_s))
    burst = np.searchsorted(last, rows)
    since = np.concatenate([[-1], last])[burst]
    return stamped(run, stamps_s[last[burst]] + 5e-4 * (rows - since - 1), name=name)


@pytest.mark.parametrize(
    ("sensors", "fewest", "most"),
    [
        *(("gyroscope and poses", 2, 2), ("gyroscope and poses", 8, 20)),
        *(("gyroscope", 2, 4), ("poses", 4, 7)),
    ],
)
def test_bursts_are_the_only_finding(driven, fewest, most, sensors):
    (found,) = check_recording(in_bursts(SENSORS[sensors](driven), fewest, most)).findings
    assert found.name == "uneven_stamps"
    assert found.level is (Level.NOTE if most == 2 else Level.WARNING)
    in_each = float(found.seen.split("bursts of ")[1].split()[0])
    assert in_each == pytest.approx((fewest + most) / 2, rel=0.05)
    assert ("of the messages of either tread" in found.cause) == (most == 2)


def test_rows_that_are_spread_have_nearly_their_own_stamps(driven):
    found, run = spread_bursts(in_bursts(driven, 3, 6))
    assert len(found) == 1
    off_s = run.odometry.stamps_s - driven.odometry.stamps_s
    assert np.abs(off_s).max() < 0.01  # of 0.3 s between bursts


def test_equal_stamps_of_a_burst_are_spread_too(driven):
    whole_s = np.repeat(driven.odometry.stamps_s[4::5], 5)
    found, run = spread_bursts(stamped(driven, whole_s))
    assert len(found) == 1
    assert run.odometry.stamps_s == pytest.approx(driven.odometry.stamps_s)


def test_rows_of_an_imu_are_spread_as_well(driven):
    turned = SENSORS["gyroscope and poses"](driven)
    rates = turned.odometry["gyro_z"]
    late = in_bursts(turned, 5, 8)
    imu = table("imu.csv", t=late.odometry.stamps_s, gyro_z=rates)
    columns = {name: turned.odometry[name] for name in ("t", "v_left", "v_right")}
    found, run = spread_bursts(replace(turned, odometry=table("odometry.csv", **columns), imu=imu))
    assert [finding.seen.split(" come")[0] for finding in found] == ["rows of imu.csv"]
    assert run.imu.stamps_s == pytest.approx(turned.odometry.stamps_s, abs=0.01)


@pytest.mark.parametrize(
    ("sensors", "fewest", "most"),
    [("gyroscope and poses", 2, 2), ("poses", 3, 5), ("gyroscope and poses", 6, 9)],
)
def test_poses_that_come_at_once_are_the_only_finding(driven, fewest, most, sensors):
    (found,) = check_recording(in_bursts(SENSORS[sensors](driven), fewest, most, "pose")).findings
    assert found.name == "pose_bursts"
    assert "rows of pose.csv come in" in found.seen


@pytest.mark.parametrize("apart_m", [0.0, 0.5])
def test_poses_of_two_sensors_that_come_together_are_left(driven, apart_m):
    each = driven.pose
    twice = {name: np.repeat(np.asarray(values), 2) for name, values in each.columns.items()}
    twice["t"][1::2] += 2e-3
    twice["x"][1::2] += apart_m
    run = replace(driven, pose=replace(each, columns=twice))
    assert spread_bursts(run)[1] is run


def test_rows_that_are_written_twice_are_used_once(driven):
    """2 ms apart, and with rows lost: no gap lies between them."""
    kept = np.flatnonzero(np.arange(len(driven.odometry)) % 50 > 0)
    once = driven.odometry.rows(kept)
    each = np.repeat(np.arange(len(once)), 2)
    stamps_s = once.stamps_s[each] + 2e-3 * (np.arange(len(each)) % 2)
    twice = replace(driven, odometry=arrivals.stamped(once, stamps_s, each))
    (found,), run = spread_bursts(twice)
    assert found.name == "repeated_rows"
    assert found.seen.startswith(f"{len(once)} rows of odometry.csv")
    assert run.odometry.stamps_s.tolist() == once.stamps_s.tolist()
    assert [found.name for found in check_recording(twice).findings] == ["repeated_rows"]


def test_rows_recorded_now_and_then_are_no_bursts(driven):
    """For a second of each eight: rows are as many as a steady logger has, and of their time."""
    at_s = driven.odometry.stamps_s
    rows = at_s % 8 < 1
    log = stamped(driven, at_s[rows], rows)
    assert spread_bursts(log) == ([], log)


def test_rows_that_may_be_recorded_now_and_then_stay_where_they_are(driven):
    """Seven rows of each hundred, their own period apart: 6 % of the time."""
    at_s = driven.odometry.stamps_s
    rows = np.arange(len(at_s)) % 100 < 7
    (found,), run = spread_bursts(stamped(driven, at_s[rows], rows))
    assert found.cause.endswith("or rows were recorded for a moment now and then")
    assert run.odometry.stamps_s.tolist() == at_s[rows].tolist()


def test_bursts_of_one_half_have_the_words_of_that_half(driven):
    whole = in_bursts(driven, 5, 5).odometry.stamps_s
    at_s = driven.odometry.stamps_s
    later = np.arange(len(at_s)) > 1500
    (found,), _ = spread_bursts(stamped(driven, np.where(later, at_s, whole)))
    assert "bursts of 5.0 rows in the mean, usually 0.25 s" in found.seen


def test_poses_without_places_and_stamps_in_milliseconds_have_none(driven):
    run = in_bursts(driven, 4, 4, "pose")
    empty = {**run.pose.columns, "x": np.full(len(run.pose), np.nan)}
    assert spread_bursts(replace(run, pose=replace(run.pose, columns=empty)))[0] == []
    late = in_bursts(driven, 5, 5)
    assert spread_bursts(stamped(driven, 1000 * late.odometry.stamps_s))[0] == []


@pytest.mark.parametrize("limit_m_s", [0.02, 0.1, 0.2])
def test_a_log_of_changes_has_no_bursts(driven, limit_m_s):
    """Rows close together where the robot speeds up, and none for seconds elsewhere."""
    steps = np.floor(driven.odometry.stack("v_left", "v_right") / limit_m_s)
    steps[np.arange(len(steps)) % 200 < 150] = 0.0  # rests between
    rows = np.append(True, (np.diff(steps, axis=0) != 0).any(axis=1))
    log = stamped(driven, driven.odometry.stamps_s[rows], rows)
    assert spread_bursts(log) == ([], log)


def test_two_quick_changes_among_single_rows_are_no_bursts(driven):
    """Of a log of changes: rows five seconds apart, and 28 close together at both ends."""
    at_s, rows = driven.odometry.stamps_s, np.arange(len(driven.odometry.stamps_s)) % 100 == 0
    for begin in (2, 2360):
        rows[begin : begin + 28] = True
    log = stamped(driven, at_s[rows], rows)
    assert spread_bursts(log) == ([], log)


def test_even_and_shaken_stamps_are_left(driven, rng):
    stamps_s = driven.odometry.stamps_s
    for each in (stamps_s, stamps_s + rng.uniform(0, 0.045, len(stamps_s))):
        run = stamped(driven, each)
        assert spread_bursts(run)[1] is run
