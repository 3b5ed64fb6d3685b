"""CSV files of satellite fixes: units of places, separators, notes."""

import numpy as np
import pytest

from odometry.fixes.fixes import read_fixes
from tests.odometry.fixes.made_fixes import (
    LATITUDES,
    LONGITUDES,
    ROWS,
    STAMPS_S,
    assert_usual,
    usual,
    written,
)


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
    assert_usual(found)
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
    assert_usual(read_fixes(written(tmp_path, columns, ";")))


def test_longitudes_up_to_360_and_across_180(tmp_path):
    east = 180 + (LONGITUDES - 11.5)
    found = read_fixes(written(tmp_path, usual(longitude=east)))
    assert len(found.places) == ROWS
    assert not found.losses
    assert np.abs(found.places[:, 1]).min() > 179.9


def test_one_angle_of_few_digits_is_noted(tmp_path):
    found = read_fixes(written(tmp_path, usual(latitude=["4.810E+01"] * ROWS)))
    assert any("have 1 decimal," in note for note in found.notes)


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
