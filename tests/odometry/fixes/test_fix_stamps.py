"""Stamps of CSV files of satellite fixes: units, dates, several columns."""

from datetime import UTC, datetime
from pathlib import Path

import numpy as np
import pytest

from odometry.errors import TrajectoryError
from odometry.fixes.fixes import read_fixes
from odometry.tables.table import Table
from tests.odometry.fixes.made_fixes import (
    BEGIN_S,
    ROWS,
    STAMPS_S,
    assert_usual,
    usual,
    written,
)


@pytest.mark.parametrize("unit", [1, 1e3, 1e6, 1e9])
def test_stamps_of_every_unit(tmp_path, unit):
    counts = [f"{value:.0f}" if unit > 1 else f"{value:.3f}" for value in STAMPS_S * unit]
    found = read_fixes(written(tmp_path, usual(time=counts)))
    assert_usual(found)
    assert not found.losses


@pytest.mark.parametrize("unit", [1, 1e3, 1e6, 1e9])
def test_stamps_from_the_start_of_a_recording(tmp_path, unit):
    counts = [f"{value:.6f}" for value in (STAMPS_S - BEGIN_S) * unit]
    found = read_fixes(written(tmp_path, usual(time=counts)))
    np.testing.assert_allclose(found.stamps_s, STAMPS_S - BEGIN_S, atol=1e-6)


@pytest.mark.parametrize("period_s", [10.0, 0.01])
def test_a_slow_receiver_is_no_fast_one(tmp_path, period_s):
    """Steps of 10 are seconds or milliseconds: the odometry lasts about as long as the fixes."""
    times = [f"{10 * k}" for k in range(ROWS)]
    lasts_s = 1.5 * ROWS * period_s
    odometry = Table(Path("odometry.csv"), {"t": np.array([0.0, lasts_s])}, np.arange(2))
    found = read_fixes(written(tmp_path, usual(time=times)), odometry)
    np.testing.assert_allclose(np.diff(found.stamps_s), period_s)


def test_a_slow_receiver_that_counts_from_1970(tmp_path):
    times = BEGIN_S + 10.0 * np.arange(ROWS)
    found = read_fixes(written(tmp_path, usual(time=times)))
    np.testing.assert_allclose(found.stamps_s, times, atol=1e-6)


@pytest.mark.parametrize(
    ("form", "said"),
    [
        ("%Y-%m-%dT%H:%M:%S.%fZ", ""),
        ("%Y-%m-%d %H:%M:%S.%f+00:00", ""),
        ("%Y/%m/%d %H:%M:%S.%f", "taken as UTC"),
    ],
)
def test_stamps_that_are_dates(tmp_path, form, said):
    dates = [datetime.fromtimestamp(stamp, UTC).strftime(form) for stamp in STAMPS_S]
    found = read_fixes(written(tmp_path, usual(time=dates)))
    assert_usual(found)
    assert ("taken as UTC" in found.notes[0]) == bool(said)


def test_seconds_and_nanoseconds_in_two_columns(tmp_path):
    columns = usual() | {
        "header.stamp.secs": [f"{value:.0f}" for value in np.floor(STAMPS_S)],
        "header.stamp.nsecs": [f"{value * 1e9:.0f}" for value in STAMPS_S % 1],
    }
    columns["time"] = STAMPS_S + 0.05  # at which they were received
    assert_usual(read_fixes(written(tmp_path, columns)))


def test_of_several_stamps_those_of_the_clock_of_the_odometry(tmp_path):
    columns = {"seconds_elapsed": STAMPS_S - BEGIN_S, **usual()}
    odometry = Table(Path("odometry.csv"), {"t": STAMPS_S}, np.arange(ROWS))
    assert_usual(read_fixes(written(tmp_path, columns), odometry))


def test_columns_that_are_no_stamps_after_all_are_passed_over(tmp_path):
    columns = {"utc_time": ["noon"] * ROWS, **usual()}
    odometry = Table(Path("odometry.csv"), {"t": STAMPS_S}, np.arange(ROWS))
    assert_usual(read_fixes(written(tmp_path, columns), odometry))
    columns.pop("time")
    with pytest.raises(TrajectoryError, match=r"row 2, column 'utc_time': 'noon' is neither"):
        read_fixes(written(tmp_path, columns), odometry)


def test_stamps_that_repeat_or_go_back_are_left_out_and_counted(tmp_path):
    stamps_s = STAMPS_S.copy()
    stamps_s[7] = stamps_s[6]
    stamps_s[20] -= 2
    found = read_fixes(written(tmp_path, usual(time=stamps_s)))
    assert len(found.places) == ROWS - 2
    assert (np.diff(found.stamps_s) > 0).all()
    assert "1 of 40 rows that repeat a stamp, row 9 first" in found.losses
    assert "1 of 40 rows whose stamp goes back, row 22 first" in found.losses


@pytest.mark.parametrize("cell", ["06:20:00.5", "12/01/2025 06:20:00", "01.12.2025 06:20:00"])
def test_times_that_are_no_dates_are_refused_in_words(tmp_path, cell):
    with pytest.raises(TrajectoryError, match=r"is neither a number nor a date with a time"):
        read_fixes(written(tmp_path, usual(time=[cell] * ROWS)))
