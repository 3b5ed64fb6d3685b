"""CSV files of satellite fixes: units, stamps, and rows that are no places."""

from datetime import UTC, datetime
from pathlib import Path

import numpy as np
import pytest

from odometry.errors import TrajectoryError
from odometry.fixes.fixes import read_fixes
from odometry.table import Table

BEGIN_S = 1_700_000_000.0
ROWS = 40
STAMPS_S = BEGIN_S + np.arange(ROWS) / 5
LATITUDES = 48.1 + np.arange(ROWS) * 2.0371e-6
LONGITUDES = 11.5 + np.sin(np.arange(ROWS) / 7) * 3e-5
HEIGHTS_M = np.full(ROWS, 512.5)


def written(folder, columns, separator=","):
    """A CSV file of columns; numbers with nine decimals, texts as they are."""
    cells = [
        [each if isinstance(each, str) else f"{each:.9f}" for each in column]
        for column in columns.values()
    ]
    file = folder / "gnss.csv"
    lines = [separator.join(columns), *(separator.join(row) for row in zip(*cells, strict=True))]
    file.write_text("\n".join(lines) + "\n", encoding="utf-8")
    return file


def usual(**changed):
    columns = {"time": STAMPS_S, "latitude": LATITUDES, "longitude": LONGITUDES}
    return columns | {"altitude": HEIGHTS_M} | changed


def expect_usual(found):
    np.testing.assert_allclose(found.stamps_s, STAMPS_S, atol=1e-6)
    np.testing.assert_allclose(found.places[:, 0], LATITUDES, atol=2e-9)
    np.testing.assert_allclose(found.places[:, 1], LONGITUDES, atol=2e-9)


@pytest.mark.parametrize("unit", [1, 1e3, 1e6, 1e9])
def test_stamps_of_every_unit(tmp_path, unit):
    counts = [f"{value:.0f}" if unit > 1 else f"{value:.3f}" for value in STAMPS_S * unit]
    found = read_fixes(written(tmp_path, usual(time=counts)))
    expect_usual(found)
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
    expect_usual(found)
    assert ("taken as UTC" in found.notes[0]) == bool(said)


def test_seconds_and_nanoseconds_in_two_columns(tmp_path):
    columns = usual() | {
        "header.stamp.secs": [f"{value:.0f}" for value in np.floor(STAMPS_S)],
        "header.stamp.nsecs": [f"{value * 1e9:.0f}" for value in STAMPS_S % 1],
    }
    columns["time"] = STAMPS_S + 0.05  # at which they were received
    expect_usual(read_fixes(written(tmp_path, columns)))


def test_of_several_stamps_those_of_the_clock_of_the_odometry(tmp_path):
    columns = {"seconds_elapsed": STAMPS_S - BEGIN_S, **usual()}
    odometry = Table(Path("odometry.csv"), {"t": STAMPS_S}, np.arange(ROWS))
    expect_usual(read_fixes(written(tmp_path, columns), odometry))


def test_columns_that_are_no_stamps_after_all_are_passed_over(tmp_path):
    columns = {"utc_time": ["noon"] * ROWS, **usual()}
    odometry = Table(Path("odometry.csv"), {"t": STAMPS_S}, np.arange(ROWS))
    expect_usual(read_fixes(written(tmp_path, columns), odometry))
    columns.pop("time")
    with pytest.raises(TrajectoryError, match=r"row 2, column 'utc_time': 'noon' is neither"):
        read_fixes(written(tmp_path, columns), odometry)


def test_whole_numbers_and_millimetres_of_a_receiver(tmp_path):
    columns = usual(
        latitude=[f"{value * 1e7:.0f}" for value in LATITUDES],
        longitude=[f"{value * 1e7:.0f}" for value in LONGITUDES],
        altitude=["512500"] * ROWS,
    )
    found = read_fixes(written(tmp_path, columns))
    np.testing.assert_allclose(found.places[:, 0], LATITUDES, atol=1e-7)
    np.testing.assert_allclose(found.places[:, 2], 512.5)
    assert "whole numbers of 1e-7 degrees" in found.notes[1]
    assert "millimetres" in found.notes[2]


@pytest.mark.parametrize("suffix", ["", "_rad"])
def test_radians(tmp_path, suffix):
    columns = usual()
    angles = {
        f"{name}{suffix}": [f"{value:.12f}" for value in np.radians(columns.pop(name))]
        for name in ("latitude", "longitude")
    }
    found = read_fixes(written(tmp_path, columns | angles))
    expect_usual(found)
    assert any("radians" in note for note in found.notes)


def test_a_simulation_at_zero_is_in_degrees(tmp_path):
    columns = usual(latitude=LATITUDES - 48.1, longitude=LONGITUDES - 11.5)
    found = read_fixes(written(tmp_path, columns))
    np.testing.assert_allclose(found.places[:, 0], LATITUDES - 48.1, atol=2e-9)
    assert not found.losses


def test_semicolons_and_commas_in_numbers(tmp_path):
    columns = {
        name: [f"{value:.9f}".replace(".", ",") for value in column]
        for name, column in usual().items()
    }
    expect_usual(read_fixes(written(tmp_path, columns, ";")))


def test_longitudes_up_to_360_and_across_180(tmp_path):
    east = 180 + (LONGITUDES - 11.5)
    found = read_fixes(written(tmp_path, usual(longitude=east)))
    assert len(found.places) == ROWS
    assert not found.losses
    assert np.abs(found.places[:, 1]).min() > 179.9


@pytest.mark.parametrize(
    ("column", "good", "bad"),
    [
        ("status", "0", "-1"),
        ("Status", "3", "1"),
        ("fix_type", "3", "1"),
        ("fix_quality", "4", "0"),
        ("status", "A", "V"),
    ],
)
def test_rows_without_a_fix_are_left_out_and_counted(tmp_path, column, good, bad):
    states = [bad if 10 <= k < 15 else good for k in range(ROWS)]
    found = read_fixes(written(tmp_path, usual(**{column: states})))
    assert len(found.places) == ROWS - 5
    (loss,) = found.losses
    assert f"5 of {ROWS} rows without a fix ({column!r} says so), row 12 first" in loss


@pytest.mark.parametrize(
    ("latitude", "longitude", "why"),
    [
        ("0.0", "0.0", "zero"),
        ("nan", "nan", "without latitude or longitude"),
        ("", "11.5", "without latitude or longitude"),
        ("N/A", "--", "without latitude or longitude"),
        ("91.5", "11.5", "no place on Earth"),
        ("37.4", "-122.1", "more than 100 km from the others"),
    ],
)
@pytest.mark.parametrize("first", [0, 20])
def test_rows_that_are_no_place_are_left_out_and_counted(tmp_path, latitude, longitude, why, first):
    columns = {name: [f"{value:.9f}" for value in each] for name, each in usual().items()}
    columns["latitude"][first : first + 3] = [latitude] * 3
    columns["longitude"][first : first + 3] = [longitude] * 3
    found = read_fixes(written(tmp_path, columns))
    assert len(found.places) == ROWS - 3
    (loss,) = found.losses
    assert f"3 of {ROWS} rows" in loss
    assert why in loss
    assert f"row {first + 2} first" in loss


def test_stamps_that_repeat_or_go_back_are_left_out_and_counted(tmp_path):
    stamps_s = STAMPS_S.copy()
    stamps_s[7] = stamps_s[6]
    stamps_s[20] -= 2
    found = read_fixes(written(tmp_path, usual(time=stamps_s)))
    assert len(found.places) == ROWS - 2
    assert (np.diff(found.stamps_s) > 0).all()
    assert "1 of 40 rows that repeat a stamp, row 9 first" in found.losses
    assert "1 of 40 rows whose stamp goes back, row 22 first" in found.losses


@pytest.mark.parametrize(
    ("changed", "why"),
    [
        ({"latitude": LONGITUDES + 128, "longitude": LATITUDES}, "when they are exchanged"),
        ({"latitude": LATITUDES * 100, "longitude": LONGITUDES * 100}, "degrees and minutes"),
        (
            {"latitude": LATITUDES + 227, "longitude": LONGITUDES + 184},
            "no place on Earth in degrees",
        ),
        ({"time": STAMPS_S[::-1]}, "row 3: its stamp goes back, as in 39 of 40 rows"),
        ({"time": (STAMPS_S - BEGIN_S) / 1e3}, "column 'time': no unit"),
        ({"latitude": ["48.1", "4x"] * 20}, "row 3, column 'latitude': '4x' is not a number"),
        ({"time": ["2026-01-01T10:00:00Z", "10:00:01"] * 20}, "row 3, column 'time': '10:00:01'"),
        ({"status": ["-1"] * ROWS}, "no row has a fix"),
        ({"latitude": np.zeros(ROWS), "longitude": np.zeros(ROWS)}, "no row has a place"),
    ],
)
def test_what_is_refused(tmp_path, changed, why):
    with pytest.raises(TrajectoryError, match=r"gnss\.csv") as refused:
        read_fixes(written(tmp_path, usual(**changed)))
    assert why in str(refused.value)


def test_rows_above_the_header_are_counted(tmp_path):
    file = written(tmp_path, usual(latitude=["48.1"] * 5 + ["?"] * 35))
    file.write_text("# one\n# two\n" + file.read_text())
    with pytest.raises(TrajectoryError, match=r"row 9, column 'latitude'"):
        read_fixes(file)


def test_other_files_are_none_of_these(tmp_path):
    file = tmp_path / "slam.tum"
    file.write_text("0 0 0 0 0 0 0 1\n")
    assert read_fixes(file) is None


@pytest.mark.parametrize("rows_each", [3, 10])
def test_places_that_a_faster_log_holds_are_left_out(tmp_path, rows_each):
    first = np.arange(ROWS) // rows_each * rows_each
    columns = usual(latitude=LATITUDES[first], longitude=LONGITUDES[first])
    found = read_fixes(written(tmp_path, columns))
    np.testing.assert_allclose(found.stamps_s, STAMPS_S[np.unique(first)], atol=1e-6)
    assert f"{ROWS - len(np.unique(first))} of {ROWS} rows that hold" in found.losses[0]


def test_places_that_are_rounded_stay(tmp_path):
    """A robot leaves cells of rounded places now sooner, now later; at rest it stays in one."""
    t = np.arange(600) / 20
    north_m = 8 * np.sin(t / 9) + 3 * np.sin(t / 2.3)
    latitudes = np.round(48.1 + north_m / 111_200, 5)
    columns = {"time": BEGIN_S + t, "latitude": latitudes, "longitude": np.full(600, 11.51234567)}
    assert (np.diff(latitudes) == 0).mean() > 0.9
    found = read_fixes(written(tmp_path, columns))
    assert not found.losses
    assert "its degrees have 5 decimals, steps of 1.1 m: write 7 or more" in found.notes


def test_kinds_of_fixes_are_counted(tmp_path):
    kinds = ["4"] * 30 + ["5"] * 8 + ["0"] * 2
    found = read_fixes(written(tmp_path, usual(fix_quality=kinds)))
    note = "'fix_quality' is 4 in 30, 5 in 8 rows: fixes of several kinds, whose errors differ"
    assert note in found.notes
    assert not any("kinds" in note for note in read_fixes(written(tmp_path, usual())).notes)


def test_small_cells_that_a_robot_leaves_evenly_stay(tmp_path):
    """Six decimals, 0.11 m, at 0.8 m/s and 20 Hz: each cell has two or three rows."""
    t = np.arange(400) / 20
    latitudes = np.round(48.1 + 0.8 * t / 111_200, 6)
    columns = {"time": BEGIN_S + t, "latitude": latitudes, "longitude": np.full(400, 11.51234567)}
    assert (np.diff(latitudes) == 0).mean() > 0.5
    assert not read_fixes(written(tmp_path, columns)).losses


def test_one_place_in_all_rows_stays(tmp_path):
    columns = usual(latitude=np.full(ROWS, 48.1), longitude=np.full(ROWS, 11.5))
    assert len(read_fixes(written(tmp_path, columns)).places) == ROWS


def test_one_angle_of_few_digits_is_noted(tmp_path):
    found = read_fixes(written(tmp_path, usual(latitude=["4.810E+01"] * ROWS)))
    assert any("have 1 decimal," in note for note in found.notes)


def test_altitudes_of_another_unit_are_left_out(tmp_path):
    found = read_fixes(written(tmp_path, usual(altitude=HEIGHTS_M * 1000)))
    assert np.isnan(found.places[:, 2]).all()
    assert any("'altitude' is beyond -500 to 9000 m in 40 rows" in note for note in found.notes)


@pytest.mark.parametrize("cell", ["06:20:00.5", "12/01/2025 06:20:00", "01.12.2025 06:20:00"])
def test_times_that_are_no_dates_are_refused_in_words(tmp_path, cell):
    with pytest.raises(TrajectoryError, match=r"is neither a number nor a date with a time"):
        read_fixes(written(tmp_path, usual(time=[cell] * ROWS)))


def test_what_ros2_echoes_as_csv_has_no_header(tmp_path):
    rest = ",".join(["0.1"] * 9)
    rows = [
        f"{int(t)},{round(t % 1 * 1e9)},gps,{-1 if k == 7 else 0},1,{a:.9f},{b:.9f},512.5,{rest},2"
        for k, (t, a, b) in enumerate(zip(STAMPS_S, LATITUDES, LONGITUDES, strict=True))
    ]
    file = tmp_path / "fix.csv"
    file.write_text("\n".join(rows) + "\n")
    found = read_fixes(file)
    assert len(found.places) == ROWS - 1
    np.testing.assert_allclose(found.stamps_s, np.delete(STAMPS_S, 7), atol=1e-6)
    np.testing.assert_allclose(found.places[:, 0], np.delete(LATITUDES, 7), atol=2e-9)
    assert "1 of 40 rows without a fix ('status.status' says so), row 8 first" in found.losses
