"""SFTA against values of programs written by others.

The values are those of `sfta-reference` in the data folder: its README says how each was made.
`ramp_100x256` has exact ties between thresholds, which every program settles in its own way.
"""

import csv
import os
from pathlib import Path

import numpy as np
import pytest

from terrain.images import read_image
from terrain.texture import sfta
from terrain.texture.borders import region_borders
from terrain.texture.box_counting import box_counts, byte_histogram
from terrain.texture.otsu import multilevel_otsu, recursive_otsu
from terrain.texture.ttbd import chen2023_members, packed_tables

DATA = os.environ.get("TERRAIN_ODOMETRY_DATA")
pytestmark = pytest.mark.skipif(DATA is None, reason="TERRAIN_ODOMETRY_DATA is not set")

TIES = "ramp_100x256"
DIMENSION_COUNT_MEAN = [0, 2, 1]  # the files have dimension, mean, count


def folder():
    return Path(DATA) / "sfta-reference"


def rows_of(name):
    with (folder() / name).open(newline="") as file:
        _, *rows = csv.reader(file)
    return [row for row in rows if row[0] != TIES]


def image_of(row):
    return read_image(folder() / "images" / f"{row[0]}.png")


def features_of(cells):
    return np.array(cells, dtype=float).reshape(-1, 3)[:, DIMENSION_COUNT_MEAN].ravel()


def test_features_of_the_text_of_the_paper():
    rows = rows_of("features_paperdef_skimageT_octave.csv")
    assert len(rows) == 31
    for row in rows:
        ours = sfta(image_of(row), int(row[1]), "chen2023")
        np.testing.assert_allclose(ours, features_of(row[3:]), rtol=0, atol=1e-9, err_msg=row[0])


def test_features_of_the_authors_code():
    """Where the authors' code has NaN, on an empty border, ours has 0."""
    rows = rows_of("features_octave_alceufc_github_6nt-3.csv")
    assert len(rows) == 66
    for row in rows:
        ours = sfta(image_of(row), int(row[3]), "costa2012")
        theirs = np.nan_to_num(features_of(row[7:]), nan=0.0)
        np.testing.assert_allclose(ours, theirs, rtol=0, atol=1e-9, err_msg=row[0])


def test_thresholds_of_the_authors_code():
    for row in rows_of("features_octave_alceufc_github_6nt-3.csv"):
        ours = recursive_otsu(byte_histogram(image_of(row)), int(row[3]))
        theirs = 255.0 * np.array(row[6].split(";"), dtype=float)
        np.testing.assert_allclose(ours, theirs, rtol=0, atol=1e-12, err_msg=row[0])


def test_exact_thresholds():
    rows = [row for row in rows_of("thresholds_skimage_multiotsu.csv") if row[2] == "ok"]
    assert len(rows) == 31
    for row in rows:
        ours = multilevel_otsu(byte_histogram(image_of(row)), int(row[1]))
        np.testing.assert_array_equal(ours, np.array(row[3:], dtype=float), err_msg=row[0])


def test_integer_box_counts():
    rows = rows_of("boxcounts_paperdef_skimageT_octave.csv")
    assert len(rows) == 184
    for row in rows:
        n_thresholds, image = int(row[1]), int(row[2]) - 1
        grey = image_of(row)
        members = chen2023_members(multilevel_otsu(byte_histogram(grey), n_thresholds))
        assert np.flatnonzero(members[image])[0] == int(row[3]) + 1
        borders = region_borders(packed_tables(members)[0][grey])
        theirs = np.array(row[6:], dtype=int)[::-1]  # from the padded side down to 1
        np.testing.assert_array_equal(box_counts(borders)[:, image], theirs, err_msg=row[0])
        assert theirs[0] == int(row[5])
