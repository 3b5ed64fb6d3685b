"""Rows of satellite fixes that are left out and counted, and files that are refused."""

import numpy as np
import pytest

from odometry.errors import TrajectoryError
from odometry.fixes.fixes import read_fixes
from tests.odometry.fixes.made_fixes import (
    BEGIN_S,
    HEIGHTS_M,
    LATITUDES,
    LONGITUDES,
    ROWS,
    STAMPS_S,
    usual,
    written,
)


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


def test_altitudes_of_another_unit_are_left_out(tmp_path):
    found = read_fixes(written(tmp_path, usual(altitude=HEIGHTS_M * 1000)))
    assert np.isnan(found.places[:, 2]).all()
    assert any("'altitude' is beyond -500 to 9000 m in 40 rows" in note for note in found.notes)
