"""Rows that came late by chance, or all at once after a stall, in the check."""

from dataclasses import replace

import numpy as np
import pytest

from odometry.checks.findings.finding import Level
from odometry.checks.recording import check_recording
from odometry.checks.stamps.late_by_chance import LAGS
from tests.odometry.arrivals import after_stalls, by_chance, cut_off, stamped, with_arrival
from tests.odometry.checks.drives import table, turning_all_round
from tests.odometry.checks.faulty import pose_stamps, positions


@pytest.fixture(scope="module")
def driven():
    return turning_all_round()


@pytest.mark.parametrize(
    ("mean_s", "level"), [(0.025, Level.NOTE), (0.12, Level.WARNING), (0.2, Level.WARNING)]
)
def test_rows_that_are_late_by_chance_are_the_only_finding(driven, mean_s, level):
    late = with_arrival(driven, lambda stamps_s: by_chance(stamps_s, mean_s))
    (found,) = check_recording(late).findings
    assert (found.name, found.level, found.spans_s) == ("uneven_stamps", level, ())
    assert "as many rows as 20 Hz ask for" in found.seen
    assert found.cause.startswith("Stamps are those of arrival")


def test_rows_after_a_stall_are_the_only_finding(driven):
    (found,) = check_recording(with_arrival(driven, after_stalls)).findings
    assert found.name == "uneven_stamps"
    assert "in 13 places they come late" in found.seen
    assert "stalled" in found.cause
    begins_s, ends_s = np.array(found.spans_s).T
    assert begins_s == pytest.approx(15.0 * np.arange(1, 14) - 1, abs=0.15)
    assert (ends_s - begins_s < 1.01).all()


def test_rows_of_an_imu_that_are_late_are_no_late_gyroscope(driven):
    late = with_arrival(driven, lambda stamps_s: by_chance(stamps_s, 0.2)).odometry
    imu = table("imu.csv", t=late.stamps_s, gyro_z=driven.odometry["gyro_z"])
    columns = {name: driven.odometry[name] for name in ("t", "v_left", "v_right")}
    run = replace(driven, odometry=table("odometry.csv", **columns), imu=imu)
    (found,) = check_recording(run).findings
    assert found.seen.startswith("imu.csv has as many rows")


def test_what_all_rows_are_late_by_is_no_early_reference(driven):
    late = with_arrival(driven, lambda stamps_s: 0.2 + by_chance(stamps_s, 0.2))
    assert [found.name for found in check_recording(late).findings] == ["uneven_stamps"]


def test_poses_that_are_late_as_well_are_said_beside(driven):
    late = with_arrival(pose_stamps(driven, lambda stamps_s: stamps_s + 0.8))
    assert [found.name for found in check_recording(late).findings] == [
        "uneven_stamps",
        "pose_late",
    ]


def test_another_fault_is_found_beside(driven):
    late = with_arrival(positions(driven, lambda x, y: (1000 * x, 1000 * y)))
    assert "position_unit" in {found.name for found in check_recording(late).findings}


def test_rows_microseconds_apart_are_in_no_unit_of_hours(driven):
    at_once_s = by_chance(np.repeat(driven.odometry.stamps_s[19::20], 20), 1e-9)
    late = replace(driven, odometry=stamped(driven.odometry, at_once_s))
    assert [found.name for found in check_recording(late).findings] == ["uneven_stamps"]
    hours = stamped(driven.odometry, driven.odometry.stamps_s / 3600)
    assert check_recording(replace(driven, odometry=hours)).findings[0].name == "stamp_unit"


@pytest.mark.parametrize("digits", [2, 3, 4])
@pytest.mark.parametrize("seed", range(3))
def test_late_rows_that_share_stamps_are_late_ones(driven, digits, seed):
    late = with_arrival(driven, lambda t: np.round(by_chance(t, seed=seed), digits))
    assert len(late.odometry.repeated_lines) > 1000
    (found,) = check_recording(late).findings
    assert (found.name, found.level) == ("uneven_stamps", Level.WARNING)


@pytest.mark.parametrize(
    ("step_s", "level", "words"),
    [
        (0.1, Level.WARNING, "up to 2 rows share one"),
        (1.0, Level.WARNING, "up to 20 rows share one"),
    ],
)
def test_stamps_in_whole_steps_are_the_only_finding(driven, step_s, level, words):
    coarse = with_arrival(driven, lambda stamps_s: cut_off(stamps_s, step_s))
    (found,) = check_recording(coarse).findings
    assert (found.name, found.level) == ("coarse_stamps", level)
    assert words in found.seen
    assert "20 Hz" in found.seen
    assert ("of the messages of either tread" in found.cause) == (step_s == 0.1)


def test_steps_that_put_rows_off_by_little_are_a_note(driven):
    at_s = np.arange(0, driven.odometry.stamps_s[-1], 0.02)
    rate = np.interp(at_s, driven.odometry.stamps_s, driven.odometry["gyro_z"])
    imu = stamped(table("imu.csv", t=at_s, gyro_z=rate), cut_off(at_s, 0.05))
    (found,) = check_recording(replace(driven, imu=imu)).findings
    assert (found.name, found.level) == ("coarse_stamps", Level.NOTE)
    assert found.seen.startswith("stamps of imu.csv")


def with_a_row_of_each_tread(run):
    """Of each moment a row in which the left tread is new, and one in which both are."""
    rows = run.odometry
    each = np.repeat(np.arange(len(rows)), 2)
    columns = {name: values[each] for name, values in rows.columns.items()}
    columns["v_right"][2::2] = rows["v_right"][:-1]
    return replace(run, odometry=stamped(replace(rows, columns=columns), columns["t"]))


def test_two_rows_of_each_moment_may_be_of_either_tread(driven):
    (found,) = check_recording(with_a_row_of_each_tread(driven)).findings
    assert found.name == "repeated_stamps"
    assert "each moment has two rows, of the messages of either tread" in found.cause


def test_delays_are_not_judged_where_other_rows_share_stamps_and_were_dropped(driven):
    rows = driven.odometry
    own_s = np.cumsum(np.random.default_rng(0).exponential(0.05, len(rows)))
    columns = {name: np.interp(own_s, rows.stamps_s, rows[name]) for name in rows.columns}
    irregular = stamped(replace(rows, columns=columns), cut_off(own_s, 0.1))
    found = check_recording(replace(driven, odometry=irregular)).findings
    assert "repeated_stamps" in [each.name for each in found]
    assert not {each.name for each in found} & LAGS
